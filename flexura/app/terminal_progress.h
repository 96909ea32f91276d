#pragma once

#include <chrono>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "flexura/base/progress.h"

namespace flexura {

/// Estimates how long a job goes on, from how long its fraction took so far.
class TimeLeft {
 public:
  /// The time left, s, when `fraction` in [0, 1] is done `elapsed` seconds after the start; missing while too
  /// little is done to say. A fraction below the last one starts a new part of the job.
  std::optional<double> at(double fraction, double elapsed);

 private:
  double begin_elapsed_ = 0;
  double begin_fraction_ = 0;
  double last_fraction_ = 0;
};

/// "12 s", "3 min 20 s", "2 h 5 min".
[[nodiscard]] std::string duration_text(double seconds);

/// A progress line on a terminal with the time left, redrawn in place a few times a second. Where stderr is
/// not a terminal it prints nothing.
class TerminalProgress : public Progress {
 public:
  explicit TerminalProgress(std::ostream& err);
  ~TerminalProgress() override;

  void update(double fraction, std::string_view what) override;
  /// Takes the line off the screen.
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
