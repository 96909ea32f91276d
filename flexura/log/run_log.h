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

/// What a run and its tasks tell: it goes into the log and to who watches.
class RunLog {
 public:
  struct Event {
    double time = 0;  ///< s
    std::string level, name, text;
  };

  /// `watcher` may be null.
  RunLog(const std::filesystem::path& file, const Arm& arm, RunWatcher* watcher)
      : recorder_(file, arm), watcher_(watcher) {}

  void event(double time, Recorder::Level level, const std::string& name, const std::string& text);
  /// Of a task's work, for who watches, too.
  void tell(const LoggedMessage& message);
  /// A camera's frame, with its logged_image.
  void image(const std::string& camera, const Frame& frame, std::string_view message);
  /// A task that was done by the rig has ended.
  void task_ended();

  /// For what only the log has.
  [[nodiscard]] Recorder& recorder() { return recorder_; }
  /// How many frames of each camera that gave any.
  [[nodiscard]] const std::map<std::string, std::int64_t>& frames() const { return frames_; }
  /// All that happened.
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }

 private:
  Recorder recorder_;
  RunWatcher* watcher_;
  std::map<std::string, std::int64_t> frames_;  // by camera
  std::vector<Event> events_;
};

}  // namespace flexura
