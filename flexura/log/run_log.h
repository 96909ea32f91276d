#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/log/recorder.h"
#include "flexura/log/run_watcher.h"

namespace flexura {

class LoggedMessage;

/// Passes the messages of a run and its tasks to the log and the watcher.
class RunLog {
 public:
  struct Event {
    double time = 0;  ///< In s.
    std::string level, name, text;
  };

  /// `watcher` may be null.
  RunLog(const std::filesystem::path& file, const Arm& arm, RunWatcher* watcher)
      : recorder_(file, arm), watcher_(watcher) {}

  void event(double time, Recorder::Level level, const std::string& name, const std::string& text);
  /// Writes a task's message to the log and passes it to the watcher.
  void publish(const LoggedMessage& message);
  /// Writes a camera's frame, with its logged_image.
  void image(const std::string& camera, const Frame& frame, std::string_view message);
  /// Reports the end of a task that the rig performed.
  void task_ended();

  /// Returns the recorder, for messages that only the log receives.
  [[nodiscard]] Recorder& recorder() { return recorder_; }
  /// Returns the number of frames of each camera that has frames.
  [[nodiscard]] const std::map<std::string, std::int64_t>& frames() const { return frames_; }
  /// Returns all events.
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }

 private:
  Recorder recorder_;
  RunWatcher* watcher_;
  std::map<std::string, std::int64_t> frames_;  // Number of frames of each camera.
  std::vector<Event> events_;
};

}  // namespace flexura
