#include "flexura/log/messages.h"

#include <cmath>

#include "flexura/base/table.h"

namespace flexura {

const Table<TimeMessage>& fields_of(const TimeMessage*) {
  static const auto table = Table<TimeMessage>("foxglove.Time", "Time since the experiment's start.")
                                .field("sec", &TimeMessage::sec, {.meaning = "Whole seconds."})
                                .field("nsec", &TimeMessage::nsec, {.meaning = "Nanoseconds beyond them."});
  return table;
}

const Table<ArmStateMessage>& fields_of(const ArmStateMessage*) {
  static const auto table =
      Table<ArmStateMessage>("flexura.ArmState", "What changes when the arm moves.")
          .field("time", &ArmStateMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("bends", &ArmStateMessage::bends,
                 {.meaning = "Each section's bend (bend_x, bend_y), rad, base first."})
          .field("stretches", &ArmStateMessage::stretches,
                 {.meaning = "The factor on each section's length."})
          .field("archings", &ArmStateMessage::archings, {.meaning = "Planar arms: the archings, rad."})
          .field("cord_angles", &ArmStateMessage::cord_angles,
                 {.meaning = "Planar arms: the cords' angles from +X, rad."});
  return table;
}

const Table<VectorMessage>& fields_of(const VectorMessage*) {
  static const auto table = Table<VectorMessage>("foxglove.Vector3", "A vector in the frame named.")
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
  static const auto table = Table<PoseMessage>("foxglove.Pose", "A frame's place and orientation.")
                                .field("position", &PoseMessage::position, {})
                                .field("orientation", &PoseMessage::orientation, {});
  return table;
}

const Table<PosesMessage>& fields_of(const PosesMessage*) {
  static const auto table =
      Table<PosesMessage>("foxglove.PosesInFrame", "Each section's base frame and, last, the tip.")
          .field("timestamp", &PosesMessage::timestamp, {})
          .field("frame_id", &PosesMessage::frame_id, {.meaning = "The frame the poses are in."})
          .field("poses", &PosesMessage::poses, {});
  return table;
}

const Table<EventMessage>& fields_of(const EventMessage*) {
  static const auto table =
      Table<EventMessage>("foxglove.Log", "Something that happened.")
          .field("timestamp", &EventMessage::timestamp, {})
          .field("level", &EventMessage::level, {.meaning = "2 info, 3 warning, 4 error."})
          .field("message", &EventMessage::message, {})
          .field("name", &EventMessage::name, {.meaning = "What speaks."})
          .field("file", &EventMessage::file, {})
          .field("line", &EventMessage::line, {});
  return table;
}

const Table<DriveCommandsMessage>& fields_of(const DriveCommandsMessage*) {
  static const auto table =
      Table<DriveCommandsMessage>("flexura.DriveCommands", "Where the motors are to go.")
          .field("time", &DriveCommandsMessage::time,
                 {.meaning = "Time by which to be there, since the experiment's start, s."})
          .field("positions", &DriveCommandsMessage::positions,
                 {.meaning = "Each axis's position, microsteps from the straight arm."})
          .field("rates", &DriveCommandsMessage::rates,
                 {.meaning = "Each axis's mean step rate since the command before, microsteps/s."});
  return table;
}

const Table<ArmReadingMessage>& fields_of(const ArmReadingMessage*) {
  static const auto table =
      Table<ArmReadingMessage>("flexura.ArmReading", "What the simulated drives say of themselves.")
          .field("time", &ArmReadingMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("bends", &ArmReadingMessage::bends,
                 {.meaning = "Each section's bend as the model makes it of the motors, rad."})
          .field("stretches", &ArmReadingMessage::stretches,
                 {.meaning = "The factor on each section's length as the model makes it of the motors."})
          .field("positions", &ArmReadingMessage::positions,
                 {.meaning = "Each axis's position, microsteps; arms with drives."})
          .field("moving", &ArmReadingMessage::moving, {.meaning = "Whether a motion is under way."});
  return table;
}

const Table<TensionsMessage>& fields_of(const TensionsMessage*) {
  static const auto table =
      Table<TensionsMessage>("flexura.Tensions", "By which the tendons of the true arm pull.")
          .field("time", &TensionsMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("tensions", &TensionsMessage::tensions,
                 {.meaning = "Each tendon's tension at the arm's base, N."})
          .field(
              "lost_steps", &TensionsMessage::lost_steps,
              {.meaning = "Microsteps that each motor has lost so far, unknown to its controller; arms with "
                          "drives."});
  return table;
}

const Table<EnergyMessage>& fields_of(const EnergyMessage*) {
  static const auto table =
      Table<EnergyMessage>("flexura.Energy", "The energy of the true arm in motion.")
          .field("time", &EnergyMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("kinetic", &EnergyMessage::kinetic, {.meaning = "Of its motion, J."})
          .field("strain", &EnergyMessage::strain, {.meaning = "Of its strains, J."})
          .field("gravity", &EnergyMessage::gravity,
                 {.meaning = "Of its weight, J; 0 at the height of the arm's base."});
  return table;
}

const Table<ContactMessage>& fields_of(const ContactMessage*) {
  static const auto table =
      Table<ContactMessage>("flexura.Contact", "Where the true arm touches something.")
          .field("s", &ContactMessage::s,
                 {.meaning = "Place on the arm: arc length from its base at rest, m."})
          .field("with", &ContactMessage::with, {.meaning = "The obstacle's name, or \"the arm\"."})
          .field("point", &ContactMessage::point, {.meaning = "In the world, m."})
          .field("force", &ContactMessage::force, {.meaning = "On the arm there, N."})
          .field("depth", &ContactMessage::depth, {.meaning = "How deep the arm is in it, m."})
          .field("normal_force", &ContactMessage::normal_force, {.meaning = "Across the surface, N."})
          .field("sticks", &ContactMessage::sticks, {.meaning = "It does not slide along the other."});
  return table;
}

const Table<ContactsMessage>& fields_of(const ContactsMessage*) {
  static const auto table =
      Table<ContactsMessage>("flexura.Contacts", "What the true arm in motion touches.")
          .field("time", &ContactsMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("contacts", &ContactsMessage::contacts, {.meaning = "None: it touches nothing any more."});
  return table;
}

const Table<HeadReadingMessage>& fields_of(const HeadReadingMessage*) {
  static const auto table =
      Table<HeadReadingMessage>("flexura.HeadReading", "Measured pan, tilt and zoom of a camera's head.")
          .field("time", &HeadReadingMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("pan", &HeadReadingMessage::pan, {.meaning = "rad, to the camera's left."})
          .field("tilt", &HeadReadingMessage::tilt, {.meaning = "rad, upwards."})
          .field("zoom", &HeadReadingMessage::zoom, {.meaning = "A ratio or a motor count."})
          .field("moving", &HeadReadingMessage::moving, {.meaning = "Whether a motion is under way."});
  return table;
}

const Table<StageReadingMessage>& fields_of(const StageReadingMessage*) {
  static const auto table =
      Table<StageReadingMessage>("flexura.StageReading", "Measured position of a camera's stage.")
          .field("time", &StageReadingMessage::time, {.meaning = "Time since the experiment's start, s."})
          .field("offset", &StageReadingMessage::offset, {.meaning = "Right, down, forward, m."})
          .field("moving", &StageReadingMessage::moving, {.meaning = "Whether a motion is under way."});
  return table;
}

const Table<ImageMessage>& fields_of(const ImageMessage*) {
  static const auto table =
      Table<ImageMessage>("foxglove.CompressedImage", "A frame of a camera.")
          .field("timestamp", &ImageMessage::timestamp, {.meaning = "Middle of the exposure."})
          .field("frame_id", &ImageMessage::frame_id, {.meaning = "The camera's optical frame."})
          .field("data", &ImageMessage::data, {.meaning = "An image file."})
          .field("format", &ImageMessage::format, {.meaning = "Its format."});
  return table;
}

const Table<AxisPointMessage>& fields_of(const AxisPointMessage*) {
  using M = AxisPointMessage;
  static const auto table =
      Table<M>("flexura.AxisPoint", "A point where the backbone was seen.")
          .field("u", &M::u, {.meaning = "Column, px."})
          .field("v", &M::v, {.meaning = "Row, px."})
          .field("sigma", &M::sigma, {.meaning = "Standard deviation across the axis, px."});
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
