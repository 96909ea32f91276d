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

// Messages of a run's log. Their tables of fields define the JSON schemas of the log, and read and write the
// messages. Messages named foxglove.* have the layout of the Foxglove schemas, so that other programs can
// display them.

/// foxglove.Time: time since the experiment's start.
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

/// foxglove.PosesInFrame, on /arm/poses (commanded) and /arm/truth (true): poses in the world. The poses are
/// the base frame of each section (in the truth, of each arc) and, as the last pose, the tip.
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
  std::string name;  ///< Source of the event: the name of a task, or "run".
  std::string file;  ///< Always empty, and `line` is always 0. `file` and `line` exist because foxglove.Log
                     ///< requires them.
  std::int64_t line = 0;
};

/// Returns "info", "warning" or "error" for a level of foxglove.Log. For levels of other programs, debug
/// counts as "info", and fatal counts as "error".
[[nodiscard]] std::string level_name(std::int64_t level);

/// flexura.DriveCommands, on /drive/commands: command of the motors at one clock step.
struct DriveCommandsMessage {
  double time = 0;                      ///< Time at which the motors must reach the positions, s.
  std::vector<std::int64_t> positions;  ///< Microsteps, one per axis.
  std::vector<double> rates;            ///< Mean rates since the previous command, microsteps/s.
};

/// flexura.ArmReading, on /arm/reading if a run simulates the rig: reading of the simulated drives.
struct ArmReadingMessage {
  double time = 0;  ///< In s.
  /// Bends, computed by the model from the motors' positions, rad.
  std::vector<std::array<double, 2>> bends;
  std::vector<double> stretches;  ///< Stretches, computed by the model from the motors' positions.
  /// Motor positions, microsteps, one per axis; only for arms with drives.
  std::optional<std::vector<std::int64_t>> positions;
  bool moving = false;
};

/// flexura.Tensions, on /arm/tensions, logged with the true arm if this arm is an elastic rod.
struct TensionsMessage {
  double time = 0;               ///< In s.
  std::vector<double> tensions;  ///< Tension of each tendon at the arm's base, N.
  /// Microsteps that each motor has lost so far; its controller does not notice this loss. Missing for arms
  /// without drives.
  std::optional<std::vector<double>> lost_steps;
};

/// flexura.Energy, on /arm/energy, logged with the true arm if this arm is an elastic rod with inertia.
struct EnergyMessage {
  double time = 0;     ///< In s.
  double kinetic = 0;  ///< Kinetic energy, J.
  double strain = 0;   ///< Elastic energy, J.
  double gravity = 0;  ///< Potential energy of the arm's weight and of loads along it, J; 0 at the height of
                       ///< the arm's base.
};

/// flexura.Contact: a contact of the true arm.
struct ContactMessage {
  double s = 0;         ///< Position on the arm: arc length from the base of the unstretched arm, m.
  std::string with;     ///< Name of the obstacle, or "the arm" for contact of the arm with itself.
  VectorMessage point;  ///< Point of contact in W, m.
  VectorMessage force;  ///< Force on the arm at the contact, in W, N.
  double depth = 0;     ///< Penetration depth, m.
  std::optional<double> normal_force = {};  ///< Normal force, N.
  std::optional<bool> sticks = {};          ///< Whether the surfaces do not slide along each other.
};
/// flexura.Contacts, on /arm/contacts, logged with the true arm if this arm is an elastic rod with inertia.
/// The message is logged while the arm touches something, and once afterwards.
struct ContactsMessage {
  double time = 0;  ///< In s.
  std::vector<ContactMessage> contacts;
};

/// flexura.HeadReading, on /head/NAME if a run simulates the rig: reading of a camera's head.
struct HeadReadingMessage {
  double time = 0;           ///< In s.
  double pan = 0, tilt = 0;  ///< In rad.
  double zoom = 1;           ///< Zoom: position in the lens's zoom table.
  bool moving = false;
};

/// flexura.StageReading, on /stage/NAME if a run simulates the rig: reading of a camera's stage.
struct StageReadingMessage {
  double time = 0;                           ///< In s.
  std::array<double, 3> offset = {0, 0, 0};  ///< Offset along the stage's axes (right, down, forward), m.
  bool moving = false;
};

/// A point of the arm's centerline as measured in a picture.
struct AxisPointMessage {
  double u = 0, v = 0;  ///< In px.
  double sigma = 0;     ///< Standard deviation perpendicular to the centerline, px.
};

/// foxglove.CompressedImage, on /camera/NAME: one frame of a camera.
struct ImageMessage {
  TimeMessage timestamp;  ///< Middle of the exposure.
  std::string frame_id;   ///< "camera/NAME".
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
/// Returns the topic of the readings of a camera's head.
[[nodiscard]] std::string head_topic(std::string_view camera);
/// Returns the topic of the readings of a camera's stage.
[[nodiscard]] std::string stage_topic(std::string_view camera);

/// Returns `time` (s, >= 0) in nanoseconds, rounded to the nearest integer.
[[nodiscard]] std::uint64_t nanoseconds(double time);
/// Returns a time as whole seconds and the remainder in nanoseconds.
[[nodiscard]] TimeMessage time_message(std::uint64_t nanoseconds);
/// Returns a pose in the world as position, m, and unit quaternion, w >= 0.
[[nodiscard]] PoseMessage pose_message(const Pose& X_WP);

/// Returns each section's bend, rad.
[[nodiscard]] std::vector<std::array<double, 2>> bends_of(const ArmState& state);
/// Returns each section's bend as [[bend_x, bend_y], ...], rad.
[[nodiscard]] Node bends_node(const ArmState& state);

/// Returns [x, y, z], m in the world.
[[nodiscard]] Node point_node(const Eigen::Vector3d& p);
/// Returns {"position": [x, y, z], "rotation": [w, x, y, z]}, the form of a pose in summaries and on the
/// command line.
[[nodiscard]] Node pose_node(const Pose& X_WP);

}  // namespace flexura
