#include "flexura/log/messages.h"

#include <cmath>

#include "flexura/base/table.h"

namespace flexura {

const Table<TimeMessage>& fields_of(const TimeMessage*) {
  static const auto table = Table<TimeMessage>("foxglove.Time", "Time since the experiment's start.")
                                .field("sec", &TimeMessage::sec, {.meaning = "Whole seconds."})
                                .field("nsec", &TimeMessage::nsec, {.meaning = "Remaining nanoseconds."});
  return table;
}

const Table<ArmStateMessage>& fields_of(const ArmStateMessage*) {
  static const auto table =
      Table<ArmStateMessage>("flexura.ArmState", "Commanded state of the arm.")
          .field("time", &ArmStateMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("bends", &ArmStateMessage::bends,
                 {.meaning = "Bend (bend_x, bend_y) of each section, rad, from the base."})
          .field("stretches", &ArmStateMessage::stretches,
                 {.meaning = "Stretch of each section, as a factor on its length."})
          .field("archings", &ArmStateMessage::archings, {.meaning = "Archings of a planar arm, rad."})
          .field("cord_angles", &ArmStateMessage::cord_angles,
                 {.meaning = "Cord angles of a planar arm from +X, rad."});
  return table;
}

const Table<VectorMessage>& fields_of(const VectorMessage*) {
  static const auto table = Table<VectorMessage>("foxglove.Vector3", "Vector in the frame of the message.")
                                .field("x", &VectorMessage::x, {.meaning = "m"})
                                .field("y", &VectorMessage::y, {.meaning = "m"})
                                .field("z", &VectorMessage::z, {.meaning = "m"});
  return table;
}

const Table<QuaternionMessage>& fields_of(const QuaternionMessage*) {
  static const auto table = Table<QuaternionMessage>("foxglove.Quaternion", "A rotation, w >= 0.")
                                .field("x", &QuaternionMessage::x, {})
                                .field("y", &QuaternionMessage::y, {})
                                .field("z", &QuaternionMessage::z, {})
                                .field("w", &QuaternionMessage::w, {});
  return table;
}

const Table<PoseMessage>& fields_of(const PoseMessage*) {
  static const auto table = Table<PoseMessage>("foxglove.Pose", "Position and orientation of a frame.")
                                .field("position", &PoseMessage::position, {})
                                .field("orientation", &PoseMessage::orientation, {});
  return table;
}

const Table<PosesMessage>& fields_of(const PosesMessage*) {
  static const auto table =
      Table<PosesMessage>("foxglove.PosesInFrame",
                          "Base frame of each section and, as the last pose, the tip.")
          .field("timestamp", &PosesMessage::timestamp, {})
          .field("frame_id", &PosesMessage::frame_id, {.meaning = "Frame in which the poses are given."})
          .field("poses", &PosesMessage::poses, {});
  return table;
}

const Table<EventMessage>& fields_of(const EventMessage*) {
  static const auto table =
      Table<EventMessage>("foxglove.Log", "Event of a run.")
          .field("timestamp", &EventMessage::timestamp, {})
          .field("level", &EventMessage::level, {.meaning = "Level: 2 info, 3 warning, 4 error."})
          .field("message", &EventMessage::message, {})
          .field("name", &EventMessage::name, {.meaning = "Source of the event."})
          .field("file", &EventMessage::file, {})
          .field("line", &EventMessage::line, {});
  return table;
}

const Table<DriveCommandsMessage>& fields_of(const DriveCommandsMessage*) {
  static const auto table =
      Table<DriveCommandsMessage>("flexura.DriveCommands", "Command of the motors at one clock step.")
          .field("time", &DriveCommandsMessage::time,
                 {.meaning =
                      "Time at which the motors must reach the positions, since the experiment's start, s."})
          .field("positions", &DriveCommandsMessage::positions,
                 {.meaning = "Position of each axis, microsteps from the straight arm."})
          .field("rates", &DriveCommandsMessage::rates,
                 {.meaning = "Mean step rate of each axis since the previous command, microsteps/s."});
  return table;
}

const Table<ArmReadingMessage>& fields_of(const ArmReadingMessage*) {
  static const auto table =
      Table<ArmReadingMessage>("flexura.ArmReading", "Reading of the simulated drives.")
          .field("time", &ArmReadingMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("bends", &ArmReadingMessage::bends,
                 {.meaning = "Bend of each section, computed by the model from the motors' positions, rad."})
          .field("stretches", &ArmReadingMessage::stretches,
                 {.meaning = "Stretch of each section, computed by the model from the motors' positions, as "
                             "a factor on its length."})
          .field("positions", &ArmReadingMessage::positions,
                 {.meaning = "Position of each axis, microsteps; only for arms with drives."})
          .field("moving", &ArmReadingMessage::moving, {.meaning = "Whether the device is moving."});
  return table;
}

const Table<TensionsMessage>& fields_of(const TensionsMessage*) {
  static const auto table =
      Table<TensionsMessage>("flexura.Tensions", "Tensions of the true arm's tendons.")
          .field("time", &TensionsMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("tensions", &TensionsMessage::tensions,
                 {.meaning = "Tension of each tendon at the arm's base, N."})
          .field("lost_steps", &TensionsMessage::lost_steps,
                 {.meaning = "Microsteps that each motor has lost so far; its controller does not notice "
                             "this loss. Missing for arms without drives."});
  return table;
}

const Table<EnergyMessage>& fields_of(const EnergyMessage*) {
  static const auto table =
      Table<EnergyMessage>("flexura.Energy", "Energies of the true arm with inertia.")
          .field("time", &EnergyMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("kinetic", &EnergyMessage::kinetic, {.meaning = "Kinetic energy, J."})
          .field("strain", &EnergyMessage::strain, {.meaning = "Elastic energy, J."})
          .field(
              "gravity", &EnergyMessage::gravity,
              {.meaning =
                   "Potential energy of the arm's weight and loads, J; 0 at the height of the arm's base."});
  return table;
}

const Table<ContactMessage>& fields_of(const ContactMessage*) {
  static const auto table =
      Table<ContactMessage>("flexura.Contact", "Contact of the true arm.")
          .field("s", &ContactMessage::s,
                 {.meaning = "Position on the arm: arc length from the base of the unstretched arm, m."})
          .field("with", &ContactMessage::with, {.meaning = "Name of the obstacle, or \"the arm\"."})
          .field("point", &ContactMessage::point, {.meaning = "Point of contact in the world frame, m."})
          .field("force", &ContactMessage::force,
                 {.meaning = "Force on the arm at the contact, in the world frame, N."})
          .field("depth", &ContactMessage::depth, {.meaning = "Penetration depth, m."})
          .field("normal_force", &ContactMessage::normal_force, {.meaning = "Normal force, N."})
          .field("sticks", &ContactMessage::sticks,
                 {.meaning = "Whether the surfaces do not slide along each other."});
  return table;
}

const Table<ContactsMessage>& fields_of(const ContactsMessage*) {
  static const auto table =
      Table<ContactsMessage>("flexura.Contacts", "Contacts of the true arm with inertia.")
          .field("time", &ContactsMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("contacts", &ContactsMessage::contacts,
                 {.meaning = "Contacts; empty in the first message after the last contact."});
  return table;
}

const Table<HeadReadingMessage>& fields_of(const HeadReadingMessage*) {
  static const auto table =
      Table<HeadReadingMessage>("flexura.HeadReading", "Measured pan, tilt and zoom of a camera's head.")
          .field("time", &HeadReadingMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("pan", &HeadReadingMessage::pan, {.meaning = "Pan, rad; positive to the camera's left."})
          .field("tilt", &HeadReadingMessage::tilt, {.meaning = "Tilt, rad; positive upwards."})
          .field("zoom", &HeadReadingMessage::zoom, {.meaning = "Zoom, as a ratio or as a motor position."})
          .field("moving", &HeadReadingMessage::moving, {.meaning = "Whether the device is moving."});
  return table;
}

const Table<StageReadingMessage>& fields_of(const StageReadingMessage*) {
  static const auto table =
      Table<StageReadingMessage>("flexura.StageReading", "Measured position of a camera's stage.")
          .field("time", &StageReadingMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("offset", &StageReadingMessage::offset,
                 {.meaning = "Offset along the stage's axes (right, down, forward), m."})
          .field("moving", &StageReadingMessage::moving, {.meaning = "Whether the device is moving."});
  return table;
}

const Table<ImageMessage>& fields_of(const ImageMessage*) {
  static const auto table =
      Table<ImageMessage>("foxglove.CompressedImage", "Frame of a camera.")
          .field("timestamp", &ImageMessage::timestamp, {.meaning = "Middle of the exposure."})
          .field("frame_id", &ImageMessage::frame_id, {.meaning = "Optical frame of the camera."})
          .field("data", &ImageMessage::data, {.meaning = "Content of the image file."})
          .field("format", &ImageMessage::format, {.meaning = "Format of the image file."});
  return table;
}

const Table<AxisPointMessage>& fields_of(const AxisPointMessage*) {
  using M = AxisPointMessage;
  static const auto table =
      Table<M>("flexura.AxisPoint", "Measured point of the backbone in a picture.")
          .field("u", &M::u, {.meaning = "Column, px."})
          .field("v", &M::v, {.meaning = "Row, px."})
          .field("sigma", &M::sigma, {.meaning = "Standard deviation perpendicular to the axis, px."});
  return table;
}

std::string level_name(std::int64_t level) {
  if (level <= 2) return "info";
  return level == 3 ? "warning" : "error";
}

std::string image_topic(std::string_view camera) { return "/camera/" + std::string(camera); }

std::string head_topic(std::string_view camera) { return "/head/" + std::string(camera); }
std::string stage_topic(std::string_view camera) { return "/stage/" + std::string(camera); }

std::uint64_t nanoseconds(double time) { return static_cast<std::uint64_t>(std::llround(time * 1e9)); }

TimeMessage time_message(std::uint64_t nanoseconds) {
  constexpr std::uint64_t a_second = 1'000'000'000;
  return {static_cast<std::int64_t>(nanoseconds / a_second),
          static_cast<std::int64_t>(nanoseconds % a_second)};
}

PoseMessage pose_message(const Pose& X_WP) {
  const Eigen::Vector4d q = quaternion_wxyz(X_WP.rotation);
  return {{X_WP.position.x(), X_WP.position.y(), X_WP.position.z()}, {q[1], q[2], q[3], q[0]}};
}

std::vector<std::array<double, 2>> bends_of(const ArmState& state) {
  std::vector<std::array<double, 2>> bends;
  bends.reserve(state.bends.size());
  for (const Eigen::Vector2d& bend : state.bends) bends.push_back({bend.x(), bend.y()});
  return bends;
}

Node bends_node(const ArmState& state) {
  Node::Array bends;
  for (const Eigen::Vector2d& bend : state.bends)
    bends.push_back({Node::Array{number_node(bend.x()), number_node(bend.y())}, {}});
  return {std::move(bends), {}};
}

Node point_node(const Eigen::Vector3d& p) { return {Node::Array{{p.x(), {}}, {p.y(), {}}, {p.z(), {}}}, {}}; }

Node pose_node(const Pose& X_WP) {
  const Eigen::Vector4d q = quaternion_wxyz(X_WP.rotation);
  return {Node::Table{{"position", {}, point_node(X_WP.position)},
                      {"rotation", {}, {Node::Array{{q[0], {}}, {q[1], {}}, {q[2], {}}, {q[3], {}}}, {}}}},
          {}};
}

}  // namespace flexura
