#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/bytes.h"
#include "flexura/base/fields.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

// The messages of a run's log. Their tables of fields give the log's JSON schemas, the writing and the
// reading back. The foxglove.* ones are laid out as that collection of schemas has them, for other programs
// to show.

/// foxglove.Time: the experiment's time since its start.
struct TimeMessage {
  std::int64_t sec = 0;
  std::int64_t nsec = 0;  ///< Beyond sec, from 0 to 999999999.
};

/// flexura.ArmState, on /arm/state.
struct ArmStateMessage {
  double time = 0;                                 ///< s
  std::vector<std::array<double, 2>> bends;        ///< rad
  std::vector<double> stretches;                   ///< Factors, one a section.
  std::optional<std::vector<double>> archings;     ///< rad; planar arms.
  std::optional<std::vector<double>> cord_angles;  ///< rad; planar arms.
};

/// foxglove.Vector3
struct VectorMessage {
  double x = 0, y = 0, z = 0;
};

/// foxglove.Quaternion
struct QuaternionMessage {
  double x = 0, y = 0, z = 0, w = 1;
};

/// foxglove.Pose
struct PoseMessage {
  VectorMessage position;         ///< m
  QuaternionMessage orientation;  ///< A unit quaternion; w stands last.
};

/// foxglove.PosesInFrame, on /arm/poses as commanded and on /arm/truth as it is: each section's base frame
/// (the truth: each arc's) and, last, the tip, in the world.
struct PosesMessage {
  TimeMessage timestamp;
  std::string frame_id;  ///< "world"
  std::vector<PoseMessage> poses;
};

/// foxglove.Log, on /events.
struct EventMessage {
  TimeMessage timestamp;
  std::int64_t level = 2;  ///< 2 info, 3 warning, 4 error.
  std::string message;
  std::string name;  ///< What speaks: a task's name, "run".
  std::string file;  ///< Empty; line 0: for other programs' sake.
  std::int64_t line = 0;
};

/// "info", "warning" or "error", for one of foxglove.Log's levels: other programs' debug messages count as
/// information, their fatal ones as errors.
[[nodiscard]] std::string level_name(std::int64_t level);

/// flexura.DriveCommands, on /drive/commands: the motors' command at one step of the clock.
struct DriveCommandsMessage {
  double time = 0;                      ///< s, by when the positions are to be reached.
  std::vector<std::int64_t> positions;  ///< Microsteps, one an axis.
  std::vector<double> rates;            ///< Microsteps/s, the mean since the command before.
};

/// flexura.ArmReading, on /arm/reading where a run plays the rig: what the simulated drives say of
/// themselves.
struct ArmReadingMessage {
  double time = 0;                                     ///< s
  std::vector<std::array<double, 2>> bends;            ///< rad, as the model makes of the motors.
  std::vector<double> stretches;                       ///< Likewise.
  std::optional<std::vector<std::int64_t>> positions;  ///< Microsteps, one an axis; arms with drives.
  bool moving = false;
};

/// flexura.HeadReading, on /head/NAME where a run plays the rig: where a camera's head says that it stands.
struct HeadReadingMessage {
  double time = 0;           ///< s
  double pan = 0, tilt = 0;  ///< rad
  double zoom = 1;           ///< A position of the lens's table.
  bool moving = false;
};

/// flexura.StageReading, on /stage/NAME beside it: where a camera's stage says that it stands.
struct StageReadingMessage {
  double time = 0;                           ///< s
  std::array<double, 3> offset = {0, 0, 0};  ///< Along its axes (right, down, forward), m.
  bool moving = false;
};

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

/// A point of the median axis, likewise; `sigma` across it.
struct AxisPointMessage {
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

/// Something that a servo's law compares in a picture: a pixel, or a line of some, px.
struct FeatureMarkMessage {
  std::vector<std::array<double, 2>> seen, wanted;
};

/// flexura.ServoSighting, on /servo/sightings: what a servo measured in one picture.
struct ServoSightingMessage {
  double time = 0;  ///< Middle of the exposure, s.
  std::string camera;
  std::int64_t frame = 0;                ///< Its number.
  std::vector<AxisPointMessage> points;  ///< Of the median axis, from base to tip.
  /// Where the wanted shape would be seen, from base to tip, px; by the camera as it is believed to be.
  std::vector<std::array<double, 2>> wanted;
  std::optional<std::vector<FeatureMarkMessage>> features;  ///< What the law compares.
  std::optional<std::string> reason;                        ///< Why the picture shows no arm.
};

/// flexura.DynamicsSample, on /dynamics/samples: the distributed arm at one time.
struct DynamicsSampleMessage {
  double time = 0;                                                    ///< s
  double kinetic_energy = 0, gravity_energy = 0, elastic_energy = 0;  ///< T, V_g, V_e, J.
  double potential = 0;                                               ///< Pi, J.
  double lyapunov = 0;                                                ///< W = T + Pi, J.
  double taken_by_law = 0, taken_by_medium = 0;                       ///< By damping since the start, J.
  double azimuth_error = 0, elevation_error = 0;  ///< Root mean square along the arm, rad,
  double spatial_error = 0;                       ///< and of both together (docs/control.md, eq. 15).
  double tip_error = 0;                           ///< m
  std::vector<double> s;                          ///< Places along the arm at rest, m,
  std::vector<double> azimuths, elevations;       ///< and its direction there, rad.
  std::vector<std::array<double, 3>> points;      ///< The base, these places, the tip, in W, m.
};

/// foxglove.CompressedImage, on /camera/NAME: one frame of a camera.
struct ImageMessage {
  TimeMessage timestamp;  ///< Middle of the exposure.
  std::string frame_id;   ///< "camera/NAME"
  Bytes data;             ///< A PNG file.
  std::string format = "png";
};

/// Where a run's log has its messages.
inline constexpr std::string_view arm_state_topic = "/arm/state";
inline constexpr std::string_view arm_poses_topic = "/arm/poses";
inline constexpr std::string_view arm_truth_topic = "/arm/truth";
inline constexpr std::string_view arm_reading_topic = "/arm/reading";
inline constexpr std::string_view drive_commands_topic = "/drive/commands";
inline constexpr std::string_view events_topic = "/events";
inline constexpr std::string_view calibration_moves_topic = "/calibration/moves";
inline constexpr std::string_view calibration_arcs_topic = "/calibration/arcs";
inline constexpr std::string_view calibration_sightings_topic = "/calibration/sightings";
inline constexpr std::string_view calibration_decisions_topic = "/calibration/decisions";
inline constexpr std::string_view servo_steps_topic = "/servo/steps";
inline constexpr std::string_view servo_sightings_topic = "/servo/sightings";
inline constexpr std::string_view dynamics_samples_topic = "/dynamics/samples";

const Table<TimeMessage>& fields_of(const TimeMessage*);
const Table<ArmStateMessage>& fields_of(const ArmStateMessage*);
const Table<VectorMessage>& fields_of(const VectorMessage*);
const Table<QuaternionMessage>& fields_of(const QuaternionMessage*);
const Table<PoseMessage>& fields_of(const PoseMessage*);
const Table<PosesMessage>& fields_of(const PosesMessage*);
const Table<EventMessage>& fields_of(const EventMessage*);
const Table<DriveCommandsMessage>& fields_of(const DriveCommandsMessage*);
const Table<ArmReadingMessage>& fields_of(const ArmReadingMessage*);
const Table<HeadReadingMessage>& fields_of(const HeadReadingMessage*);
const Table<StageReadingMessage>& fields_of(const StageReadingMessage*);
const Table<ImageMessage>& fields_of(const ImageMessage*);
const Table<CalibrationMoveMessage>& fields_of(const CalibrationMoveMessage*);
const Table<CalibrationArcMessage>& fields_of(const CalibrationArcMessage*);
const Table<CircleMessage>& fields_of(const CircleMessage*);
const Table<MarkerMessage>& fields_of(const MarkerMessage*);
const Table<AxisPointMessage>& fields_of(const AxisPointMessage*);
const Table<SeenValueMessage>& fields_of(const SeenValueMessage*);
const Table<CalibrationSightingMessage>& fields_of(const CalibrationSightingMessage*);
const Table<CalibrationDecisionMessage>& fields_of(const CalibrationDecisionMessage*);
const Table<FeatureMarkMessage>& fields_of(const FeatureMarkMessage*);
const Table<ServoSightingMessage>& fields_of(const ServoSightingMessage*);
const Table<DynamicsSampleMessage>& fields_of(const DynamicsSampleMessage*);

/// The topic of a camera's images.
[[nodiscard]] std::string image_topic(std::string_view camera);
/// Of the images that the simulator has in their place.
[[nodiscard]] std::string ideal_image_topic(std::string_view camera);
/// Of the readings of its head.
[[nodiscard]] std::string head_topic(std::string_view camera);
/// Of the readings of its stage.
[[nodiscard]] std::string stage_topic(std::string_view camera);

/// Nanoseconds of `time` s >= 0, rounded to the nearest.
[[nodiscard]] std::uint64_t nanoseconds(double time);
/// The same time as whole seconds and what is beyond them.
[[nodiscard]] TimeMessage time_message(std::uint64_t nanoseconds);
/// A pose in the world: its position, m, and its unit quaternion, w >= 0.
[[nodiscard]] PoseMessage pose_message(const Pose& X_WP);

/// Each section's bend, rad.
[[nodiscard]] std::vector<std::array<double, 2>> bends_of(const ArmState& state);
/// The same as [[bend_x, bend_y], ...].
[[nodiscard]] Node bends_node(const ArmState& state);

/// [x, y, z], m in the world.
[[nodiscard]] Node point_node(const Eigen::Vector3d& p);
/// {"position": [x, y, z], "rotation": [w, x, y, z]}: a pose as summaries and the command line print it.
[[nodiscard]] Node pose_node(const Pose& X_WP);

}  // namespace flexura
