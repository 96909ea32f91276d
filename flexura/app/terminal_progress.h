#pragma once

#include <chrono>
#include <iosfwd>
#include <string_view>

#include "flexura/base/progress.h"

namespace flexura {

/// A progress line on a terminal, redrawn in place a few times a second; nothing when stderr is no terminal.
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
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace flexura
