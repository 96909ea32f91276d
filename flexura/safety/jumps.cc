#include "flexura/safety/jumps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace flexura {
namespace {

struct Sample {
  double time = 0;
  ArmState state;
};

double change(const ArmState& a, const ArmState& b, std::size_t i) {
  return std::max((a.bends[i] - b.bends[i]).norm(), std::abs(a.stretches[i] - b.stretches[i]));
}

std::optional<Jump> jump_between(const Motion& motion, Sample a, Sample b) {
  constexpr int halvings = 40;
  constexpr int few = 6;
  const double whole = largest_change(a.state, b.state);
  double size = whole;
  for (int n = 1; n <= halvings && size > smallest_jump; ++n) {
    Sample middle{(a.time + b.time) / 2, {}};
    middle.state = motion.at(middle.time);
    const double first = largest_change(a.state, middle.state);
    const double second = largest_change(middle.state, b.state);
    size = std::max(first, second);
    (first > second ? b : a) = std::move(middle);
    // The change of a smooth motion would have decreased to about 1/64.
    if (n == few && size < whole / 32) return std::nullopt;
  }
  if (size <= smallest_jump) return std::nullopt;
  const std::size_t section = most_changed(a.state, b.state);
  return Jump{b.time, size, section, changes_stretch(a.state, b.state, section)};
}

}  // namespace

double largest_change(const ArmState& a, const ArmState& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.bends.size(); ++i) most = std::max(most, change(a, b, i));
  return most;
}

std::size_t most_changed(const ArmState& a, const ArmState& b) {
  std::size_t most = 0;
  for (std::size_t i = 1; i < a.bends.size(); ++i) {
    if (change(a, b, i) > change(a, b, most)) most = i;
  }
  return most;
}

bool changes_stretch(const ArmState& a, const ArmState& b, std::size_t section) {
  return std::abs(a.stretches[section] - b.stretches[section]) > (a.bends[section] - b.bends[section]).norm();
}

std::vector<Jump> find_jumps(const Motion& motion, double step, double until,
                             const std::function<bool(double done)>& go_on) {
  const double end = std::min(until, motion.duration());
  std::vector<Jump> jumps;
  const auto count = static_cast<std::size_t>(std::ceil(end / step));
  Sample last{0, motion.at(0)};
  for (std::size_t k = 1; k <= count; ++k) {
    Sample next{std::min(static_cast<double>(k) * step, end), {}};
    next.state = motion.at(next.time);
    if (go_on && !go_on(static_cast<double>(k) / static_cast<double>(count))) break;
    if (const auto jump = jump_between(motion, last, next)) jumps.push_back(*jump);
    last = std::move(next);
  }
  return jumps;
}

}  // namespace flexura
