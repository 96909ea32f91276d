#include "flexura/app/terminal_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <ostream>
#include <string>

#include "flexura/base/one_line.h"

namespace flexura {

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

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
  const auto left = time_left_.at(fraction, std::chrono::duration<double>(now - start_).count());
  const int filled = static_cast<int>(std::lround(fraction * width));
  err_ << fmt::format("\r\x1b[K{:3.0f} % [{}{}] {}{}", fraction * 100,
                      std::string(static_cast<std::size_t>(filled), '#'),
                      std::string(static_cast<std::size_t>(width - filled), '.'),
                      left ? duration_text(*left) + " left, " : "", one_line(what))
       << std::flush;
}

void TerminalProgress::clear() {
  if (shown_) err_ << "\r\x1b[K" << std::flush;
  shown_ = false;
}

}  // namespace flexura
