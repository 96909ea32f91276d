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
#include "flexura/view/seeing_choice.h"

// Requests of clients (docs/viewer-protocol.md, "From the page").
namespace flexura {

/// Moves the arm to a shape given by bends or by tendon displacements. If the rig has actuators, each tendon
/// is pulled to its displacement, regardless of the resulting shape.
struct ArmRequest : ShapeConfig {
  std::optional<std::vector<double>> tendons;  ///< Tendon displacements, m.
  double duration = 0;                         ///< Duration of the move, s.
};
struct TipRequest {
  std::array<double, 3> position = {0, 0, 0};      ///< Tip position in W, m.
  std::optional<std::array<double, 3>> direction;  ///< Direction of the tip's z axis in W, not zero.
};
struct HeadRequest {
  std::string camera;
  std::optional<double> pan, tilt, zoom;
};
struct StageRequest {
  std::string camera;
  std::optional<double> x, y, z;  ///< Offsets along the stage's axes, m.
};
struct HaltRequest {};
struct ResetRequest {};
struct WeightRequest {
  bool on = true;
};
/// Pushes the simulated arm at a point of its backbone: by a spring to a fixed point, or by a force.
struct PushRequest {
  double s = 0;                                ///< Arc length along the unstretched arm, m.
  std::optional<std::array<double, 3>> to;     ///< Fixed end of the spring in W, m; not allowed with `force`.
  std::optional<std::array<double, 3>> force;  ///< Constant force in W, N; not allowed with `to`.
  /// Stiffness of the spring, N/m; default: the stiffness given in the controls.
  std::optional<double> stiffness;
};
struct ReleaseRequest {};
struct RunRequest {
  std::optional<std::int64_t> task;  ///< Index of the task, from 0; missing: all tasks.
  double speed = 1;                  ///< Speed relative to real time; 0: as fast as possible.
  /// Regions and colours that replace those of the experiment.
  std::vector<CameraSeeingChoice> seeing = {};
};
/// Changes the speed of an active run of tasks.
struct SpeedRequest {
  double speed = 1;  ///< Speed relative to real time; 0: as fast as possible.
};
struct CancelRequest {};
struct OpenRequest {
  std::optional<std::string> example;  ///< Name of the example; default: the recording of the last run.
};
struct LiveRequest {};
/// Opens a live rig that starts in a state of the recording.
struct BranchRequest {
  double time = 0;  ///< Time in the recording, s.
};
/// Requests the text of the experiment.
struct ExperimentRequest {
  /// Addition to the text. "pose": adds a task that moves the arm to the shown pose. "view": makes the shown
  /// view of `camera` its start.
  std::optional<std::string> add;
  std::optional<std::string> camera;  ///< Name of the camera for "view".
};
/// The text of a file, with any number of lines.
struct FileText {
  std::string content;
};
/// Checks a text as an experiment file.
struct CheckRequest {
  FileText text;
};
/// Saves a text as a new experiment file.
struct SaveRequest {
  FileText text;
  std::string name;  ///< Name of the file, with its ending.
};
struct AtRequest {
  double time = 0;  ///< Time in the recording, s.
};
struct ImagesRequest {
  std::string camera;
  double rate = 0;  ///< Images per second; 0 ends the stream.
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
/// Requests the colour of the arm at a pixel.
struct ColorRequest {
  std::string camera;
  std::int64_t u = 0, v = 0;
};
struct MeasureRequest {
  std::string camera;
  std::optional<std::vector<std::string>> layers;  ///< Names of the layers; default: all layers.
  /// Replaces region and colour in the experiment, and the projected base; default: nothing is replaced.
  std::optional<SeeingChoice> seeing = {};
};
struct ShapeRequest {
  std::vector<CameraSeeingChoice> seeing = {};  ///< As in MeasureRequest, for some of the cameras.
};
struct PointRequest {
  double s = 0;  ///< Arc length along the unstretched arm, m.
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
const Table<BranchRequest>& fields_of(const BranchRequest*);
const Table<ExperimentRequest>& fields_of(const ExperimentRequest*);
const Table<CheckRequest>& fields_of(const CheckRequest*);
const Table<SaveRequest>& fields_of(const SaveRequest*);
const Table<AtRequest>& fields_of(const AtRequest*);
const Table<ImagesRequest>& fields_of(const ImagesRequest*);
const Table<AckRequest>& fields_of(const AckRequest*);
const Table<PixelRequest>& fields_of(const PixelRequest*);
const Table<ColorRequest>& fields_of(const ColorRequest*);
const Table<MeasureRequest>& fields_of(const MeasureRequest*);
const Table<ShapeRequest>& fields_of(const ShapeRequest*);
const Table<PointRequest>& fields_of(const PointRequest*);
const Table<BackboneRequest>& fields_of(const BackboneRequest*);
const Table<PingRequest>& fields_of(const PingRequest*);

using Ask = std::variant<ArmRequest, TipRequest, HeadRequest, StageRequest, HaltRequest, ResetRequest,
                         WeightRequest, PushRequest, ReleaseRequest, RunRequest, SpeedRequest, CancelRequest,
                         OpenRequest, LiveRequest, BranchRequest, ExperimentRequest, CheckRequest,
                         SaveRequest, AtRequest, ImagesRequest, AckRequest, PixelRequest, ColorRequest,
                         MeasureRequest, ShapeRequest, PointRequest, BackboneRequest, PingRequest>;

/// The request in one message, or the reason why the message is invalid.
struct Request {
  /// Identifier, which is repeated in the reply; may be missing only for `ack`.
  std::optional<std::int64_t> id;
  Ask ask = PingRequest{};
  std::string error;  ///< Reason why the request is invalid, in one line; "" if `ask` is valid.
};

/// Parses a message. No message makes this function throw an exception. The session checks whether the
/// request fits the rig.
[[nodiscard]] Request read_request(std::string_view text);

}  // namespace flexura
