#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm_config.h"

// What clients ask (docs/viewer-protocol.md, "From the page").
namespace flexura {

/// Arms go to shapes by their bends, or by their tendons' displacements; of an arm with actuators these go
/// there one by one, whatever shape that makes.
struct ArmRequest : ShapeConfig {
  std::optional<std::vector<double>> tendons;  ///< m
  double duration = 0;                         ///< s
};
struct TipRequest {
  std::array<double, 3> position = {0, 0, 0};      ///< m
  std::optional<std::array<double, 3>> direction;  ///< Not zero.
};
struct HeadRequest {
  std::string camera;
  std::optional<double> pan, tilt, zoom;
};
struct StageRequest {
  std::string camera;
  std::optional<double> x, y, z;  ///< m
};
struct HaltRequest {};
struct ResetRequest {};
struct WeightRequest {
  bool on = true;
};
/// Something pushes the simulated arm at a point of its middle line: a spring to a place, or a force.
struct PushRequest {
  double s = 0;                                ///< Along the unstretched arm, m.
  std::optional<std::array<double, 3>> to;     ///< The spring's other end, m; one of the two.
  std::optional<std::array<double, 3>> force;  ///< N
  std::optional<double> stiffness;             ///< Of the spring, N/m; the controls' where it is left out.
};
struct ReleaseRequest {};
struct RunRequest {
  std::optional<std::int64_t> task;  ///< Its place, from 0; all of them where it is left out.
  double speed = 1;                  ///< Of real time; 0: as fast as possible.
};
/// A run of tasks that goes on plays faster or slower.
struct SpeedRequest {
  double speed = 1;  ///< Of real time; 0: as fast as possible.
};
struct CancelRequest {};
struct OpenRequest {
  std::optional<std::string> example;  ///< Its name; the recording of the last run where it is left out.
};
struct LiveRequest {};
struct AtRequest {
  double time = 0;  ///< s
};
struct ImagesRequest {
  std::string camera;
  double rate = 0;  ///< 1/s; 0 ends it.
  std::int64_t quality = 80;
};
struct AckRequest {
  std::string camera;
  std::int64_t number = 0;
};
struct PixelRequest {
  std::string camera;
  std::int64_t u = 0, v = 0;
};
struct MeasureRequest {
  std::string camera;
  std::optional<std::vector<std::string>> layers;  ///< All of them where it is left out.
};
struct ShapeRequest {};
struct PointRequest {
  double s = 0;  ///< Along the unstretched arm, m.
};
struct BackboneRequest : ShapeConfig {};
struct PingRequest {};

const Table<ArmRequest>& fields_of(const ArmRequest*);
const Table<TipRequest>& fields_of(const TipRequest*);
const Table<HeadRequest>& fields_of(const HeadRequest*);
const Table<StageRequest>& fields_of(const StageRequest*);
const Table<HaltRequest>& fields_of(const HaltRequest*);
const Table<ResetRequest>& fields_of(const ResetRequest*);
const Table<WeightRequest>& fields_of(const WeightRequest*);
const Table<PushRequest>& fields_of(const PushRequest*);
const Table<ReleaseRequest>& fields_of(const ReleaseRequest*);
const Table<RunRequest>& fields_of(const RunRequest*);
const Table<SpeedRequest>& fields_of(const SpeedRequest*);
const Table<CancelRequest>& fields_of(const CancelRequest*);
const Table<OpenRequest>& fields_of(const OpenRequest*);
const Table<LiveRequest>& fields_of(const LiveRequest*);
const Table<AtRequest>& fields_of(const AtRequest*);
const Table<ImagesRequest>& fields_of(const ImagesRequest*);
const Table<AckRequest>& fields_of(const AckRequest*);
const Table<PixelRequest>& fields_of(const PixelRequest*);
const Table<MeasureRequest>& fields_of(const MeasureRequest*);
const Table<ShapeRequest>& fields_of(const ShapeRequest*);
const Table<PointRequest>& fields_of(const PointRequest*);
const Table<BackboneRequest>& fields_of(const BackboneRequest*);
const Table<PingRequest>& fields_of(const PingRequest*);

using Ask = std::variant<ArmRequest, TipRequest, HeadRequest, StageRequest, HaltRequest, ResetRequest,
                         WeightRequest, PushRequest, ReleaseRequest, RunRequest, SpeedRequest, CancelRequest,
                         OpenRequest, LiveRequest, AtRequest, ImagesRequest, AckRequest, PixelRequest,
                         MeasureRequest, ShapeRequest, PointRequest, BackboneRequest, PingRequest>;

/// What one message asks, or why it asks nothing.
struct Request {
  std::optional<std::int64_t> id;  ///< What its reply shall bear; only `ack` may have none.
  Ask ask = PingRequest{};
  std::string error;  ///< One line; "" when `ask` is good.
};

/// Reads a message. Never throws on its account; whether it fits a rig is the session's to say.
[[nodiscard]] Request read_request(std::string_view text);

}  // namespace flexura
