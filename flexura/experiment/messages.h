#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/bytes.h"
#include "flexura/base/table.h"
#include "flexura/math/pose.h"

namespace flexura {

// The messages of a run's log. Their tables of fields give the log's JSON schemas, the writing and the
// reading back. The foxglove.* ones are laid out as that collection of schemas has them, for other programs
// to show.

/// foxglove.Time: the experiment's time since its start.
struct TimeMessage {
  std::int64_t sec = 0;
  std::int64_t nsec = 0;
};

/// flexura.ArmState, on /arm/state.
struct ArmStateMessage {
  double time = 0;                           ///< s
  std::vector<std::array<double, 2>> bends;  ///< rad
  std::vector<double> stretches;
  std::optional<std::vector<double>> archings;     ///< rad; planar arms.
  std::optional<std::vector<double>> cord_angles;  ///< rad; planar arms.
};

struct VectorMessage {
  double x = 0, y = 0, z = 0;
};

struct QuaternionMessage {
  double x = 0, y = 0, z = 0, w = 1;
};

struct PoseMessage {
  VectorMessage position;  ///< m
  QuaternionMessage orientation;
};

/// foxglove.PosesInFrame, on /arm/poses: each section's base frame and, last, the tip, in the world.
struct PosesMessage {
  TimeMessage timestamp;
  std::string frame_id;
  std::vector<PoseMessage> poses;
};

/// foxglove.Log, on /events.
struct EventMessage {
  TimeMessage timestamp;
  std::int64_t level = 2;  ///< 2 info, 3 warning, 4 error.
  std::string message;
  std::string name;  ///< What speaks: a task's name, "run".
  std::string file;
  std::int64_t line = 0;
};

/// flexura.DriveCommands, on /drive/commands: the motors' command at one step of the clock.
struct DriveCommandsMessage {
  double time = 0;                      ///< s, by when the positions are to be reached.
  std::vector<std::int64_t> positions;  ///< Microsteps, one an axis.
  std::vector<double> rates;            ///< Microsteps/s, the mean since the command before.
};

/// flexura.ArmReading, on /arm/reading in filmed runs: what the simulated drives say of themselves.
struct ArmReadingMessage {
  double time = 0;                                     ///< s
  std::vector<std::array<double, 2>> bends;            ///< rad, as the model makes of the motors.
  std::vector<double> stretches;                       ///< Likewise.
  std::optional<std::vector<std::int64_t>> positions;  ///< Microsteps, one an axis; arms with drives.
  bool moving = false;
};

/// flexura.HeadReading, on /head/NAME in filmed runs: where a camera's head says that it stands.
struct HeadReadingMessage {
  double time = 0;           ///< s
  double pan = 0, tilt = 0;  ///< rad
  double zoom = 1;           ///< A position of the lens's table.
  bool moving = false;
};

/// foxglove.CompressedImage, on /camera/NAME: one frame of a camera.
struct ImageMessage {
  TimeMessage timestamp;  ///< Middle of the exposure.
  std::string frame_id;   ///< "camera/NAME"
  Bytes data;             ///< A PNG file.
  std::string format = "png";
};

inline constexpr std::string_view arm_state_topic = "/arm/state";
inline constexpr std::string_view arm_poses_topic = "/arm/poses";
inline constexpr std::string_view arm_reading_topic = "/arm/reading";
inline constexpr std::string_view drive_commands_topic = "/drive/commands";
inline constexpr std::string_view events_topic = "/events";

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
const Table<ImageMessage>& fields_of(const ImageMessage*);

/// The topics of a camera's images, and of its head's readings.
[[nodiscard]] std::string image_topic(std::string_view camera);
[[nodiscard]] std::string head_topic(std::string_view camera);

/// Nanoseconds of `time` s >= 0, rounded to the nearest.
[[nodiscard]] std::uint64_t nanoseconds(double time);
[[nodiscard]] TimeMessage time_message(std::uint64_t nanoseconds);
[[nodiscard]] PoseMessage pose_message(const Pose& X_WP);

/// [x, y, z].
[[nodiscard]] Node point_node(const Eigen::Vector3d& p);
/// {"position": [x, y, z], "rotation": [w, x, y, z]}: a pose as summaries and the command line print it.
[[nodiscard]] Node pose_node(const Pose& X_WP);

}  // namespace flexura
