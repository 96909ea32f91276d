#include "flexura/calibrate/offset_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace flexura {
namespace {

constexpr std::size_t patience = 6;

// Whether the last offsets alternate in sign without shrinking.
bool goes_back_and_forth(std::span<const double> last) {
  for (std::size_t i = 1; i < last.size(); ++i)
    if (last[i] * last[i - 1] >= 0) return false;
  constexpr double as_large = 0.8;
  return std::abs(last.back()) > as_large * std::abs(last.front());
}

// Whether the last offsets only grow.
bool runs_away(std::span<const double> last) {
  for (std::size_t i = 1; i < last.size(); ++i)
    if (std::abs(last[i]) <= std::abs(last[i - 1])) return false;
  return true;
}

}  // namespace

LoopState OffsetSteps::take(double offset) {
  const bool are_alike = !(largest_ > 0);
  if (!offsets_.empty()) {
    const double last = offsets_.back();
    const bool is_over = offset * last < 0 && std::abs(offset) > 0.5 * std::abs(last);
    if (is_over || std::abs(offset) > std::abs(last)) share_ *= 0.5;
  }
  offsets_.push_back(offset);
  move_ = 0;
  if (std::abs(offset) <= accepted_) return LoopState::holds;
  if (offsets_.size() >= patience) {
    const auto last = std::span(offsets_).last(patience);
    if (are_alike && goes_back_and_forth(last))
      reason_ = fmt::format(
          "oscillates and cannot stop: a step changes the offset by {:.3g}, and the tolerance of {:.3g} is "
          "less than half of this change",
          std::abs(offset - last[patience - 2]), accepted_);
    else if (runs_away(last))
      reason_ =
          fmt::format("diverges: {} grew from {:.4g} to {:.4g} in {} steps",
                      are_alike ? "the offset" : "the required motion", last.front(), offset, patience - 1);
    if (!reason_.empty()) return LoopState::stuck;
  }
  move_ = are_alike ? std::copysign(1.0, offset) : std::clamp(share_ * offset, -largest_, largest_);
  return LoopState::moves;
}

}  // namespace flexura
