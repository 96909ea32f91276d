#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "flexura/base/image.h"
#include "flexura/experiment/messages.h"
#include "flexura/experiment/scene_messages.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"
#include "flexura/port/camera_port.h"
#include "flexura/port/motion_ports.h"
#include "flexura/servo/servo_step.h"

namespace flexura {

/// What logs have of a camera's frame: an ImageMessage as JSON.
[[nodiscard]] std::string logged_image(const std::string& camera, const Frame& frame);

/// Writes a run's log.mcap: the arm's state, the poses of its sections, and events (docs/log-format.md).
/// Times are the experiment's, in s from its start.
class Recorder {
 public:
  /// Starts a new log; std::runtime_error when the file exists or cannot be written.
  Recorder(const std::filesystem::path& file, const Arm& arm);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void state(double time, const ArmState& state, const Backbone& backbone);
  enum class Level : std::uint8_t { info = 2, warning = 3, error = 4 };  ///< foxglove.Log's numbers.
  void event(double time, Level level, std::string_view source, std::string_view text);

  /// What stands there, or part of it. The first message opens the channel (both).
  void scene(double time, const SceneMessage& message);
  void frames(double time, const FramesMessage& message);

  /// The first command opens the channel: logs of arms without a drive have none.
  void commands(const DriveCommandsMessage& message);

  /// The arm as it truly is, where a rig plays. The first opens the channel.
  void truth(double time, const Backbone& backbone);

  /// What a rig's devices say of themselves. The first reading opens the channel.
  void reading(const ArmReading& reading);
  void reading(const std::string& camera, const HeadReading& reading);
  void reading(const std::string& camera, const StageReading& reading);

  /// What a calibration does, sees and decides. The first message of each kind opens its channel.
  void calibration(const CalibrationMoveMessage& message);
  void calibration(const CalibrationArcMessage& message, const Image<std::uint8_t>& ideal);
  void calibration(const CalibrationSightingMessage& message, double received);
  void calibration(const CalibrationDecisionMessage& message);

  /// What a servo sends and sees. Likewise.
  void servo(const ServoStep& step);
  void servo(const ServoSightingMessage& message, double received);

  /// What a distributed arm does. Likewise.
  void dynamics(const DynamicsSampleMessage& message);

  /// A frame; `message` is its logged_image, which takes longest and needs no log. The first one of a camera
  /// opens its channel.
  void image(const std::string& camera, const Frame& frame, std::string_view message);

  /// Completes the log. Without it, as after a crash, the log reads up to its last complete chunk.
  void close();

 private:
  struct Channels;
  std::unique_ptr<Channels> channels_;
  Arm arm_;
};

}  // namespace flexura
