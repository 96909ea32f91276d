#include "flexura/app/terminal_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <ostream>
#include <string>

#include "flexura/base/one_line.h"

namespace flexura {

TerminalProgress::TerminalProgress(std::ostream& err) : err_(err), on_terminal_(isatty(STDERR_FILENO) == 1) {}

TerminalProgress::~TerminalProgress() { clear(); }

void TerminalProgress::update(double fraction, std::string_view what) {
  if (!on_terminal_) return;
  constexpr std::chrono::milliseconds between_updates{100};
  const auto now = std::chrono::steady_clock::now();
  if (shown_ && now - last_ < between_updates) return;
  last_ = now;
  shown_ = true;
  constexpr int width = 30;
  const int filled = static_cast<int>(std::lround(fraction * width));
  err_ << fmt::format("\r\x1b[K{:3.0f} % [{}{}] {}", fraction * 100,
                      std::string(static_cast<std::size_t>(filled), '#'),
                      std::string(static_cast<std::size_t>(width - filled), '.'), one_line(what))
       << std::flush;
}

void TerminalProgress::clear() {
  if (shown_) err_ << "\r\x1b[K" << std::flush;
  shown_ = false;
}

}  // namespace flexura
