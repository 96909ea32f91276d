#include "flexura/experiment/recorder.h"

#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "flexura/base/table.h"
#include "flexura/experiment/messages.h"
#include "flexura/kinematics/shape.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_writer.h"
#include "flexura/store/schema.h"

namespace flexura {
namespace {

// An ImageMessage of a topic, as JSON.
std::string image_text(const std::string& topic, double time, const Picture& picture) {
  // A run waits for every frame: quickly made rather than small.
  constexpr PngConfig quick{.level = 1};
  const ImageMessage message{time_message(nanoseconds(time)),
                             topic.substr(1),
                             {std::visit([&](const auto& image) { return png(image, quick); }, picture)}};
  return write_json(Codec<ImageMessage>::write(message));
}

}  // namespace

struct Recorder::Channels {
  explicit Channels(const std::filesystem::path& file)
      : log(file),
        state(add<ArmStateMessage>(arm_state_topic)),
        poses(add<PosesMessage>(arm_poses_topic)),
        events(add<EventMessage>(events_topic)) {}

  template <class M>
  std::uint16_t add(std::string_view topic) {
    const TableInfo& info = fields_of(static_cast<const M*>(nullptr)).info();
    return log.add_channel(
        {std::string(topic), "json", {info.name, "jsonschema", write_json(json_schema(info))}, {}});
  }

  template <class M>
  void write(std::uint16_t channel, std::uint64_t time, const M& message) {
    log.write(channel, time, write_json(Codec<M>::write(message)));
  }
  // Opens the channel at its first message.
  template <class M>
  void write(std::optional<std::uint16_t>& channel, std::string_view topic, double time, const M& message) {
    if (!channel) channel = add<M>(topic);
    write(*channel, nanoseconds(time), message);
  }
  void write_image(const std::string& topic, double time, std::string_view message) {
    const auto [channel, is_new] = images.try_emplace(topic);
    if (is_new) channel->second = add<ImageMessage>(topic);
    log.write(channel->second, nanoseconds(time), message);
  }

  McapWriter log;
  std::uint16_t state;
  std::uint16_t poses;
  std::uint16_t events;
  std::optional<std::uint16_t> scene;
  std::optional<std::uint16_t> frames;
  std::optional<std::uint16_t> commands;
  std::optional<std::uint16_t> truth;
  std::optional<std::uint16_t> arm_reading;
  std::optional<std::uint16_t> calibration_moves, calibration_arcs, calibration_sightings,
      calibration_decisions;
  std::optional<std::uint16_t> servo_steps, servo_sightings;
  std::optional<std::uint16_t> dynamics_samples;
  std::map<std::string, std::uint16_t> heads;   // by camera
  std::map<std::string, std::uint16_t> stages;  // by camera
  std::map<std::string, std::uint16_t> images;  // by topic
};

Recorder::Recorder(const std::filesystem::path& file, const Arm& arm)
    : channels_(std::make_unique<Channels>(file)), arm_(arm) {}

Recorder::~Recorder() = default;

void Recorder::state(double time, const ArmState& state, const Backbone& backbone) {
  const std::uint64_t log_time = nanoseconds(time);
  ArmStateMessage message{.time = time,
                          .bends = bends_of(state),
                          .stretches = state.stretches,
                          .archings = {},
                          .cord_angles = {}};
  if (arm_.kind == ArmKind::planar) {
    message.archings = archings(state);
    message.cord_angles = cord_angles(arm_, state);
  }
  channels_->write(channels_->state, log_time, message);

  PosesMessage poses{time_message(log_time), "world", {}};
  for (const Arc& arc : backbone.arcs())
    if (arc.section == poses.poses.size()) poses.poses.push_back(pose_message(arc.X_WS));
  poses.poses.push_back(pose_message(backbone.tip()));
  channels_->write(channels_->poses, log_time, poses);
}

void Recorder::truth(double time, const Backbone& backbone) {
  PosesMessage poses{time_message(nanoseconds(time)), "world", {}};
  for (const Arc& arc : backbone.arcs()) poses.poses.push_back(pose_message(arc.X_WS));
  poses.poses.push_back(pose_message(backbone.tip()));
  channels_->write(channels_->truth, arm_truth_topic, time, poses);
}

void Recorder::event(double time, Level level, std::string_view source, std::string_view text) {
  const std::uint64_t log_time = nanoseconds(time);
  channels_->write(channels_->events, log_time,
                   EventMessage{time_message(log_time), static_cast<std::int64_t>(level), std::string(text),
                                std::string(source), "", 0});
}

void Recorder::scene(double time, const SceneMessage& message) {
  if (!channels_->scene) channels_->scene = channels_->add<SceneMessage>(scene_topic);
  channels_->write(*channels_->scene, nanoseconds(time), message);
}

void Recorder::frames(double time, const FramesMessage& message) {
  if (!channels_->frames) channels_->frames = channels_->add<FramesMessage>(frames_topic);
  channels_->write(*channels_->frames, nanoseconds(time), message);
}

void Recorder::commands(const DriveCommandsMessage& message) {
  if (!channels_->commands) channels_->commands = channels_->add<DriveCommandsMessage>(drive_commands_topic);
  channels_->write(*channels_->commands, nanoseconds(message.time), message);
}

void Recorder::reading(const ArmReading& reading) {
  if (!channels_->arm_reading) channels_->arm_reading = channels_->add<ArmReadingMessage>(arm_reading_topic);
  ArmReadingMessage message{.time = reading.time,
                            .bends = bends_of(reading.state),
                            .stretches = reading.state.stretches,
                            .positions = {},
                            .moving = reading.moving};
  if (!reading.positions.empty()) message.positions = reading.positions;
  channels_->write(*channels_->arm_reading, nanoseconds(reading.time), message);
}

void Recorder::reading(const std::string& camera, const HeadReading& reading) {
  const auto [channel, is_new] = channels_->heads.try_emplace(camera);
  if (is_new) channel->second = channels_->add<HeadReadingMessage>(head_topic(camera));
  const HeadState& state = reading.state;
  channels_->write(channel->second, nanoseconds(reading.time),
                   HeadReadingMessage{reading.time, state.pan, state.tilt, state.zoom, reading.moving});
}

void Recorder::reading(const std::string& camera, const StageReading& reading) {
  const auto [channel, is_new] = channels_->stages.try_emplace(camera);
  if (is_new) channel->second = channels_->add<StageReadingMessage>(stage_topic(camera));
  const Eigen::Vector3d& offset = reading.state.offset;
  channels_->write(channel->second, nanoseconds(reading.time),
                   StageReadingMessage{reading.time, {offset.x(), offset.y(), offset.z()}, reading.moving});
}

void Recorder::calibration(const CalibrationMoveMessage& message) {
  channels_->write(channels_->calibration_moves, calibration_moves_topic, message.time, message);
}

void Recorder::calibration(const CalibrationArcMessage& message, const Image<std::uint8_t>& ideal) {
  channels_->write(channels_->calibration_arcs, calibration_arcs_topic, message.time, message);
  const std::string topic = ideal_image_topic(message.camera);
  channels_->write_image(topic, message.time, image_text(topic, message.time, ideal));
}

void Recorder::calibration(const CalibrationSightingMessage& message, double received) {
  channels_->write(channels_->calibration_sightings, calibration_sightings_topic, received, message);
}

void Recorder::calibration(const CalibrationDecisionMessage& message) {
  channels_->write(channels_->calibration_decisions, calibration_decisions_topic, message.time, message);
}

void Recorder::servo(const ServoStep& step) {
  channels_->write(channels_->servo_steps, servo_steps_topic, step.time, step);
}

void Recorder::servo(const ServoSightingMessage& message, double received) {
  channels_->write(channels_->servo_sightings, servo_sightings_topic, received, message);
}

void Recorder::dynamics(const DynamicsSampleMessage& message) {
  channels_->write(channels_->dynamics_samples, dynamics_samples_topic, message.time, message);
}

std::string logged_image(const std::string& camera, const Frame& frame) {
  return image_text(image_topic(camera), frame.time, *frame.picture);
}

void Recorder::image(const std::string& camera, const Frame& frame, std::string_view message) {
  channels_->write_image(image_topic(camera), frame.received, message);
}

void Recorder::close() { channels_->log.close(); }

}  // namespace flexura
