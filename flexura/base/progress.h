#pragma once

#include <string_view>

namespace flexura {

/// Receives progress reports of a long job. Implementations print a line on a terminal or send a message to
/// the viewer.
class Progress {
 public:
  virtual ~Progress() = default;
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports that `fraction` of the job, in [0, 1], is done; `what` names the current part of the job.
  virtual void update(double fraction, std::string_view what) = 0;
  /// Returns whether the job should stop early and return normally. The job calls this function often, from
  /// its own thread.
  [[nodiscard]] virtual bool is_cancelled() const { return false; }
};

/// Ignores the reports.
class NoProgress : public Progress {
 public:
  void update(double /*fraction*/, std::string_view /*what*/) override {}
};

}  // namespace flexura
