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

/// flexura.Tensions, on /arm/tensions beside the true arm, where that is an elastic rod.
struct TensionsMessage {
  double time = 0;               ///< s
  std::vector<double> tensions;  ///< By which each tendon pulls at the arm's base, N.
  /// Microsteps that each motor has lost so far, unknown to its controller; arms with drives.
  std::optional<std::vector<double>> lost_steps;
};

/// flexura.Energy, on /arm/energy beside the true arm, where that is an elastic rod in motion.
struct EnergyMessage {
  double time = 0;     ///< s
  double kinetic = 0;  ///< J
  double strain = 0;   ///< J
  double gravity = 0;  ///< Of its weight and of loads along it, J; 0 at the height of the arm's base.
};

/// flexura.Contact: where the true arm touches something.
struct ContactMessage {
  double s = 0;                             ///< Place on the arm: arc length from its base at rest, m.
  std::string with;                         ///< The obstacle's name, or "the arm".
  VectorMessage point;                      ///< In the world, m.
  VectorMessage force;                      ///< On the arm there, N.
  double depth = 0;                         ///< m
  std::optional<double> normal_force = {};  ///< Across the surface, N.
  std::optional<bool> sticks = {};          ///< It does not slide along the other.
};
/// flexura.Contacts, on /arm/contacts beside the true arm, where that is an elastic rod in motion that
/// touches something or did so at the time before.
struct ContactsMessage {
  double time = 0;  ///< s
  std::vector<ContactMessage> contacts;
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

/// A point of the median axis as it was measured in a picture; `sigma` across it.
struct AxisPointMessage {
  double u = 0, v = 0;  ///< px
  double sigma = 0;     ///< px
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

/// The topic of a camera's images.
[[nodiscard]] std::string image_topic(std::string_view camera);
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
