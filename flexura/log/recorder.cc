#include "flexura/log/recorder.h"

#include <functional>
#include <map>
#include <variant>

#include "flexura/base/table.h"
#include "flexura/kinematics/shape.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/messages.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_writer.h"
#include "flexura/store/schema.h"

namespace flexura {
namespace {

// Returns an ImageMessage of a topic as JSON.
std::string image_text(const std::string& topic, double time, const Picture& picture) {
  // A run waits for every frame: speed matters more than size.
  constexpr PngConfig quick{.level = 1};
  const ImageMessage message{time_message(nanoseconds(time)),
                             topic.substr(1),
                             {std::visit([&](const auto& image) { return png(image, quick); }, picture)}};
  return write_json(Codec<ImageMessage>::write(message));
}

PosesMessage poses_message(double time) { return {time_message(nanoseconds(time)), "world", {}}; }

}  // namespace

struct Recorder::Channels {
  // Opens the channels that exist from the start, in this order.
  explicit Channels(const std::filesystem::path& file) : log(file) {
    (void)channel(arm_state_topic, info_of<ArmStateMessage>());
    (void)channel(arm_poses_topic, info_of<PosesMessage>());
    (void)channel(events_topic, info_of<EventMessage>());
  }

  template <class M>
  static const TableInfo& info_of() {
    return fields_of(static_cast<const M*>(nullptr)).info();
  }

  std::uint16_t channel(std::string_view topic, const TableInfo& info) {
    const auto known = by_topic.find(topic);
    if (known != by_topic.end()) return known->second;
    const std::uint16_t added = log.add_channel(
        {std::string(topic), "json", {info.name, "jsonschema", write_json(json_schema(info))}, {}});
    return by_topic.emplace(topic, added).first->second;
  }

  void write_image(const std::string& topic, double time, std::string_view message) {
    log.write(channel(topic, info_of<ImageMessage>()), nanoseconds(time), message);
  }

  McapWriter log;
  std::map<std::string, std::uint16_t, std::less<>> by_topic;
};

Recorder::Recorder(const std::filesystem::path& file, const Arm& arm)
    : channels_(file.empty() ? nullptr : std::make_unique<Channels>(file)), arm_(arm) {}

Recorder::~Recorder() = default;

void Recorder::write(const LoggedMessage& message) {
  if (channels_ == nullptr) return;
  channels_->log.write(channels_->channel(message.topic(), message.schema()), nanoseconds(message.time()),
                       write_json(message.node()));
}

void Recorder::state(double time, const ArmState& state, const Backbone& backbone) {
  if (channels_ == nullptr) return;
  ArmStateMessage message{.time = time,
                          .bends = bends_of(state),
                          .stretches = state.stretches,
                          .archings = {},
                          .cord_angles = {}};
  if (arm_.kind == ArmKind::planar) {
    message.archings = archings(state);
    message.cord_angles = cord_angles(arm_, state);
  }
  write({arm_state_topic, time, message});

  PosesMessage poses = poses_message(time);
  for (const Arc& arc : backbone.arcs())
    if (arc.section == poses.poses.size()) poses.poses.push_back(pose_message(arc.X_WS));
  poses.poses.push_back(pose_message(backbone.tip()));
  write({arm_poses_topic, time, poses});
}

void Recorder::truth(double time, const Backbone& backbone) {
  if (channels_ == nullptr) return;
  PosesMessage poses = poses_message(time);
  for (const Arc& arc : backbone.arcs()) poses.poses.push_back(pose_message(arc.X_WS));
  poses.poses.push_back(pose_message(backbone.tip()));
  write({arm_truth_topic, time, poses});
}

void Recorder::event(double time, Level level, std::string_view source, std::string_view text) {
  write({events_topic, time,
         EventMessage{time_message(nanoseconds(time)), static_cast<std::int64_t>(level), std::string(text),
                      std::string(source), "", 0}});
}

void Recorder::reading(const ArmReading& reading) {
  ArmReadingMessage message{.time = reading.time,
                            .bends = bends_of(reading.state),
                            .stretches = reading.state.stretches,
                            .positions = {},
                            .moving = reading.moving};
  if (!reading.positions.empty()) message.positions = reading.positions;
  write({arm_reading_topic, reading.time, message});
}

void Recorder::reading(const std::string& camera, const HeadReading& reading) {
  const HeadState& state = reading.state;
  write({head_topic(camera), reading.time,
         HeadReadingMessage{reading.time, state.pan, state.tilt, state.zoom, reading.moving}});
}

void Recorder::reading(const std::string& camera, const StageReading& reading) {
  const Eigen::Vector3d& offset = reading.state.offset;
  write({stage_topic(camera), reading.time,
         StageReadingMessage{reading.time, {offset.x(), offset.y(), offset.z()}, reading.moving}});
}

std::string logged_image(const std::string& camera, const Frame& frame) {
  return image_text(image_topic(camera), frame.time, *frame.picture);
}

void Recorder::image(const std::string& camera, const Frame& frame, std::string_view message) {
  if (channels_ != nullptr) channels_->write_image(image_topic(camera), frame.received, message);
}

void Recorder::picture(const std::string& topic, double time, const Picture& picture) {
  if (channels_ != nullptr) channels_->write_image(topic, time, image_text(topic, time, picture));
}

void Recorder::close() {
  if (channels_ != nullptr) channels_->log.close();
}

}  // namespace flexura
