#pragma once

#include <chrono>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "flexura/base/progress.h"

namespace flexura {

/// Estimates the remaining time of a job from its progress so far.
class TimeLeft {
 public:
  /// Returns the remaining time, s, given that `fraction` in [0, 1] is done `elapsed` seconds after the
  /// start. Returns std::nullopt while too little of the job is done for an estimate. A fraction below the
  /// previous one starts a new part of the job.
  std::optional<double> at(double fraction, double elapsed);

 private:
  double begin_elapsed_ = 0;
  double begin_fraction_ = 0;
  double last_fraction_ = 0;
};

/// Returns a duration as text: "12 s", "3 min 20 s", "2 h 5 min".
[[nodiscard]] std::string duration_text(double seconds);

/// A progress line on a terminal with the remaining time, redrawn in place a few times a second. Prints
/// nothing if stderr is not a terminal.
class TerminalProgress : public Progress {
 public:
  explicit TerminalProgress(std::ostream& err);
  ~TerminalProgress() override;

  void update(double fraction, std::string_view what) override;
  /// Removes the line from the screen.
  void clear();

 private:
  std::ostream& err_;
  bool on_terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_{};
  TimeLeft time_left_;
};

}  // namespace flexura
