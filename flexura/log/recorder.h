#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "flexura/base/image.h"
#include "flexura/log/messages.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"
#include "flexura/port/camera_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

class LoggedMessage;

/// Returns the logged form of a camera's frame: an ImageMessage as JSON.
[[nodiscard]] std::string logged_image(const std::string& camera, const Frame& frame);

/// Writes a run's log.mcap: the arm's state, the poses of its sections, events (docs/log-format.md), and any
/// message with a table of fields. Times are in s from the experiment's start. The first message of a topic
/// opens its channel.
class Recorder {
 public:
  /// Starts a new log. An empty `file` means no log: messages are dropped. Throws std::runtime_error if the
  /// file exists or cannot be written.
  Recorder(const std::filesystem::path& file, const Arm& arm);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void state(double time, const ArmState& state, const Backbone& backbone);
  enum class Level : std::uint8_t { info = 2, warning = 3, error = 4 };  ///< Numbers of foxglove.Log.
  void event(double time, Level level, std::string_view source, std::string_view text);

  /// Writes any other message.
  void write(const LoggedMessage& message);

  /// Writes the backbone of the true arm.
  void truth(double time, const Backbone& backbone);

  /// Writes the reading of a device of the rig.
  void reading(const ArmReading& reading);
  void reading(const std::string& camera, const HeadReading& reading);
  void reading(const std::string& camera, const StageReading& reading);

  /// Writes a frame. `message` is the frame's logged_image(). Computing this message takes most of the time
  /// for a frame; a thread other than the recorder's can compute it.
  void image(const std::string& camera, const Frame& frame, std::string_view message);
  /// Writes a picture that is not a camera's frame on the topic `topic`.
  void picture(const std::string& topic, double time, const Picture& picture);

  /// Completes the log. A log that was not completed, for example because of a crash, is readable up to its
  /// last complete chunk.
  void close();

 private:
  struct Channels;
  std::unique_ptr<Channels> channels_;
  Arm arm_;
};

}  // namespace flexura
