#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/log/messages.h"

namespace flexura {

// The messages of a calibration (log/messages.h).

/// flexura.CalibrationMove, on /calibration/moves: a command of a calibration.
struct CalibrationMoveMessage {
  double time = 0;                                          ///< s
  std::string device;                                       ///< "arm", or a camera's name.
  std::optional<std::vector<std::array<double, 2>>> bends;  ///< Of the arm, rad.
  std::optional<double> duration;                           ///< Of its way there, s.
  std::optional<double> pan, tilt;                          ///< Of a camera, rad.
  std::optional<double> zoom;                               ///< A position of the lens's table.
  std::optional<std::array<double, 3>> stage;               ///< m
};

/// flexura.CalibrationArc, on /calibration/arcs: what the simulator has of an arc that a camera is to look
/// at.
struct CalibrationArcMessage {
  double time = 0;                                     ///< s
  std::string camera;                                  ///< Whose.
  std::string plane;                                   ///< "XOY" or "ZOY".
  std::vector<std::array<double, 2>> bends;            ///< rad
  std::vector<double> rotations;                       ///< Of the bends, rad.
  std::optional<std::vector<std::int64_t>> positions;  ///< Of the motors, microsteps; arms with drives.
  PoseMessage pose;                                    ///< Of the ideal camera,
  double focal = 0;                                    ///< and its focal length, px.
};

/// A marker as it was measured in a picture.
struct MarkerMessage {
  double s = 0;         ///< m along the unstretched arm.
  double u = 0, v = 0;  ///< px
  double sigma = 0;     ///< px
};

/// Any other number, likewise.
struct SeenValueMessage {
  std::string name;  ///< With its unit.
  double value = 0;
};

/// A circle through such points.
struct CircleMessage {
  double u = 0, v = 0;  ///< Its centre, px.
  double radius = 0;    ///< px
  bool verified = false;
};

/// flexura.CalibrationSighting, on /calibration/sightings: what was measured in one picture.
struct CalibrationSightingMessage {
  double time = 0;        ///< Middle of the exposure, s.
  std::int64_t look = 0;  ///< From 1; 0: the arm is looked for.
  std::string camera;
  std::int64_t frame = 0;                    ///< Its number.
  double pan = 0, tilt = 0;                  ///< As read, rad.
  double zoom = 1;                           ///< Likewise.
  std::array<double, 3> stage = {0, 0, 0};   ///< Likewise, m.
  std::vector<std::array<double, 2>> bends;  ///< Likewise, rad.
  std::vector<MarkerMessage> markers;
  std::vector<AxisPointMessage> points;                 ///< Of the median axis, from base to tip.
  std::int64_t unknown = 0;                             ///< Markers seen that were not recognised.
  std::optional<std::string> reason;                    ///< Why the picture is of no use.
  std::optional<std::vector<SeenValueMessage>> values;  ///< Of the paper's methods.
  std::optional<CircleMessage> circle;                  ///< Likewise.
  /// Where the ideal camera would see the axis, from base to tip, px; methods with arcs.
  std::optional<std::vector<std::array<double, 2>>> ideal;
};

/// flexura.CalibrationDecision, on /calibration/decisions: what is known after a look, and what follows.
struct CalibrationDecisionMessage {
  double time = 0;                             ///< s
  std::int64_t looks = 0;                      ///< Up to now.
  bool found = false;                          ///< A rig was found.
  std::optional<std::string> reason;           ///< Why no rig was found, or the end came early.
  double rms = 0;                              ///< Of the residuals, in standard deviations.
  std::int64_t doubts = 0;                     ///< Things seen that were left out.
  double angle = 0;                            ///< Between the axes where the cameras would be sent, rad.
  double angle_sigma = 0;                      ///< rad
  std::array<double, 2> focal = {0, 0};        ///< px
  std::array<double, 2> focal_sigma = {0, 0};  ///< Shares.
  double zoom_ratio_sigma = 0;                 ///< Share.
  std::string next;                            ///< In words.
  std::optional<std::string> camera, step;     ///< Of the paper's methods: whose offset, and in which step.
  std::optional<double> offset, accepted;      ///< Likewise: how large it is, and may be.
  std::optional<std::string> unit;             ///< Of both.
  std::optional<bool> ended;                   ///< The last one: `next` says how it ended.
};

inline constexpr std::string_view calibration_moves_topic = "/calibration/moves";
inline constexpr std::string_view calibration_arcs_topic = "/calibration/arcs";
inline constexpr std::string_view calibration_sightings_topic = "/calibration/sightings";
inline constexpr std::string_view calibration_decisions_topic = "/calibration/decisions";

const Table<CalibrationMoveMessage>& fields_of(const CalibrationMoveMessage*);
const Table<CalibrationArcMessage>& fields_of(const CalibrationArcMessage*);
const Table<CircleMessage>& fields_of(const CircleMessage*);
const Table<MarkerMessage>& fields_of(const MarkerMessage*);
const Table<SeenValueMessage>& fields_of(const SeenValueMessage*);
const Table<CalibrationSightingMessage>& fields_of(const CalibrationSightingMessage*);
const Table<CalibrationDecisionMessage>& fields_of(const CalibrationDecisionMessage*);

/// Of the images that the simulator has in the place of a camera's.
[[nodiscard]] std::string ideal_image_topic(std::string_view camera);

}  // namespace flexura
