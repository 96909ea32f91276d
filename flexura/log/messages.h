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

// Messages of a run's log. Their tables of fields give the log's JSON schemas and read and write them. The
// foxglove.* messages follow the layout of that collection of schemas, for display in other programs.

/// foxglove.Time: the experiment's time since its start.
struct TimeMessage {
  std::int64_t sec = 0;
  std::int64_t nsec = 0;  ///< Remainder, from 0 to 999999999.
};

/// flexura.ArmState, on /arm/state.
struct ArmStateMessage {
  double time = 0;                                 ///< In s.
  std::vector<std::array<double, 2>> bends;        ///< In rad.
  std::vector<double> stretches;                   ///< Factors, one per section.
  std::optional<std::vector<double>> archings;     ///< In rad; planar arms.
  std::optional<std::vector<double>> cord_angles;  ///< In rad; planar arms.
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
  VectorMessage position;         ///< In m.
  QuaternionMessage orientation;  ///< Unit quaternion; w is last.
};

/// foxglove.PosesInFrame, on /arm/poses (commanded) and /arm/truth (true): each section's base frame (for the
/// truth, each arc's) and, last, the tip, in the world.
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
  std::string name;  ///< Source: a task's name, "run".
  std::string file;  ///< Empty, with line 0: for compatibility with other programs.
  std::int64_t line = 0;
};

/// Returns "info", "warning" or "error" for a level of foxglove.Log. Debug messages of other programs count
/// as information, fatal ones as errors.
[[nodiscard]] std::string level_name(std::int64_t level);

/// flexura.DriveCommands, on /drive/commands: the motors' command at one clock step.
struct DriveCommandsMessage {
  double time = 0;                      ///< Time at which the positions are to be reached, s.
  std::vector<std::int64_t> positions;  ///< Microsteps, one per axis.
  std::vector<double> rates;            ///< Microsteps/s, mean since the previous command.
};

/// flexura.ArmReading, on /arm/reading if a run plays the rig: reading of the simulated drives.
struct ArmReadingMessage {
  double time = 0;                                     ///< In s.
  std::vector<std::array<double, 2>> bends;            ///< In rad; by the model from the motors.
  std::vector<double> stretches;                       ///< By the model from the motors.
  std::optional<std::vector<std::int64_t>> positions;  ///< Microsteps, one per axis; arms with drives.
  bool moving = false;
};

/// flexura.Tensions, on /arm/tensions with the true arm, if it is an elastic rod.
struct TensionsMessage {
  double time = 0;               ///< In s.
  std::vector<double> tensions;  ///< Tension of each tendon at the arm's base, N.
  /// Microsteps that each motor has lost so far, unknown to its controller; arms with drives.
  std::optional<std::vector<double>> lost_steps;
};

/// flexura.Energy, on /arm/energy with the true arm, if it is an elastic rod in motion.
struct EnergyMessage {
  double time = 0;     ///< In s.
  double kinetic = 0;  ///< In J.
  double strain = 0;   ///< In J.
  double gravity = 0;  ///< Of its weight and of loads along it, J; 0 at the height of the arm's base.
};

/// flexura.Contact: a contact of the true arm.
struct ContactMessage {
  double s = 0;                             ///< Place on the arm: arc length from its base at rest, m.
  std::string with;                         ///< The obstacle's name, or "the arm".
  VectorMessage point;                      ///< In the world, m.
  VectorMessage force;                      ///< On the arm there, N.
  double depth = 0;                         ///< m
  std::optional<double> normal_force = {};  ///< Across the surface, N.
  std::optional<bool> sticks = {};          ///< It does not slide along the other.
};
/// flexura.Contacts, on /arm/contacts with the true arm, if it is an elastic rod in motion. Logged while it
/// touches something, and once afterwards.
struct ContactsMessage {
  double time = 0;  ///< In s.
  std::vector<ContactMessage> contacts;
};

/// flexura.HeadReading, on /head/NAME if a run plays the rig: reading of a camera's head.
struct HeadReadingMessage {
  double time = 0;           ///< In s.
  double pan = 0, tilt = 0;  ///< In rad.
  double zoom = 1;           ///< Position in the lens's table.
  bool moving = false;
};

/// flexura.StageReading, on /stage/NAME if a run plays the rig: reading of a camera's stage.
struct StageReadingMessage {
  double time = 0;                           ///< In s.
  std::array<double, 3> offset = {0, 0, 0};  ///< Along its axes (right, down, forward), m.
  bool moving = false;
};

/// A point of the centerline as measured in a picture; `sigma` across it.
struct AxisPointMessage {
  double u = 0, v = 0;  ///< In px.
  double sigma = 0;     ///< In px.
};

/// foxglove.CompressedImage, on /camera/NAME: one frame of a camera.
struct ImageMessage {
  TimeMessage timestamp;  ///< Middle of the exposure.
  std::string frame_id;   ///< "camera/NAME"
  Bytes data;             ///< A PNG file.
  std::string format = "png";
};

/// Topics of the messages in a run's log.
inline constexpr std::string_view arm_state_topic = "/arm/state";
inline constexpr std::string_view arm_poses_topic = "/arm/poses";
inline constexpr std::string_view arm_truth_topic = "/arm/truth";
inline constexpr std::string_view arm_tensions_topic = "/arm/tensions";
inline constexpr std::string_view arm_energy_topic = "/arm/energy";
inline constexpr std::string_view arm_contacts_topic = "/arm/contacts";
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
const Table<TensionsMessage>& fields_of(const TensionsMessage*);
const Table<EnergyMessage>& fields_of(const EnergyMessage*);
const Table<ContactMessage>& fields_of(const ContactMessage*);
const Table<ContactsMessage>& fields_of(const ContactsMessage*);
const Table<HeadReadingMessage>& fields_of(const HeadReadingMessage*);
const Table<StageReadingMessage>& fields_of(const StageReadingMessage*);
const Table<ImageMessage>& fields_of(const ImageMessage*);
const Table<AxisPointMessage>& fields_of(const AxisPointMessage*);

/// Returns the topic of a camera's images.
[[nodiscard]] std::string image_topic(std::string_view camera);
/// Returns the topic of the readings of its head.
[[nodiscard]] std::string head_topic(std::string_view camera);
/// Returns the topic of the readings of its stage.
[[nodiscard]] std::string stage_topic(std::string_view camera);

/// Returns `time` s >= 0 in nanoseconds, rounded to the nearest.
[[nodiscard]] std::uint64_t nanoseconds(double time);
/// Returns the time as whole seconds and the remainder.
[[nodiscard]] TimeMessage time_message(std::uint64_t nanoseconds);
/// Returns a pose in the world as position, m, and unit quaternion, w >= 0.
[[nodiscard]] PoseMessage pose_message(const Pose& X_WP);

/// Returns each section's bend, rad.
[[nodiscard]] std::vector<std::array<double, 2>> bends_of(const ArmState& state);
/// Returns each section's bend as [[bend_x, bend_y], ...], rad.
[[nodiscard]] Node bends_node(const ArmState& state);

/// Returns [x, y, z], m in the world.
[[nodiscard]] Node point_node(const Eigen::Vector3d& p);
/// Returns {"position": [x, y, z], "rotation": [w, x, y, z]}: a pose as in summaries and on the command line.
[[nodiscard]] Node pose_node(const Pose& X_WP);

}  // namespace flexura
