#include "flexura/log/run_log.h"

#include "flexura/log/logged_message.h"

namespace flexura {

void RunLog::event(double time, Recorder::Level level, const std::string& name, const std::string& text) {
  recorder_.event(time, level, name, text);
  events_.push_back({time, level_name(static_cast<std::int64_t>(level)), name, text});
  if (watcher_ != nullptr) watcher_->happened(time, events_.back().level, name, text);
}

void RunLog::publish(const LoggedMessage& message) {
  recorder_.write(message);
  if (watcher_ != nullptr) watcher_->logged(message);
}

void RunLog::image(const std::string& camera, const Frame& frame, std::string_view message) {
  recorder_.image(camera, frame, message);
  ++frames_[camera];
}

void RunLog::task_ended() {
  if (watcher_ != nullptr) watcher_->task_ended();
}

}  // namespace flexura
