#pragma once

#include <string_view>

namespace flexura {

/// Told by a long job how far it is; what it does with that (a line on a terminal, a message to the viewer)
/// is its own.
class Progress {
 public:
  virtual ~Progress() = default;
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` in [0, 1] is done; `what` names the present part of the job.
  virtual void update(double fraction, std::string_view what) = 0;
  /// Whether the job shall end early, in good order. Asked often, from the job's thread.
  [[nodiscard]] virtual bool is_cancelled() const { return false; }
};

}  // namespace flexura
