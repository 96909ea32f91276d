#pragma once

#include <chrono>
#include <iosfwd>
#include <string>
#include <string_view>

#include "flexura/base/progress.h"
#include "flexura/base/time_left.h"

namespace flexura {

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
