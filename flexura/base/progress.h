#pragma once

#include <string_view>

namespace flexura {

/// Receives the progress of a long job; implementations print a line on a terminal or send a message to the
/// viewer.
class Progress {
 public:
  virtual ~Progress() = default;
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports that `fraction` in [0, 1] is done; `what` names the present part of the job.
  virtual void update(double fraction, std::string_view what) = 0;
  /// Returns whether the job should end early, in good order. Called often, from the job's thread.
  [[nodiscard]] virtual bool is_cancelled() const { return false; }
};

}  // namespace flexura
