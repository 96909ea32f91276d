#include "flexura/calibrate/offset_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flexura {
namespace {

constexpr std::size_t patience = 6;

// The last offsets change sign each time and become no smaller.
bool goes_back_and_forth(const std::vector<double>& offsets) {
  if (offsets.size() < patience) return false;
  for (std::size_t i = offsets.size() - patience + 1; i < offsets.size(); ++i)
    if (offsets[i] * offsets[i - 1] >= 0) return false;
  constexpr double as_large = 0.8;
  return std::abs(offsets.back()) > as_large * std::abs(offsets[offsets.size() - patience]);
}

// The last offsets only grow.
bool runs_away(const std::vector<double>& offsets) {
  if (offsets.size() < patience) return false;
  for (std::size_t i = offsets.size() - patience + 1; i < offsets.size(); ++i)
    if (std::abs(offsets[i]) <= std::abs(offsets[i - 1])) return false;
  return true;
}

}  // namespace

LoopState EqualSteps::take(double offset) {
  offsets_.push_back(offset);
  move_ = 0;
  if (std::abs(offset) <= accepted_) return LoopState::holds;
  if (goes_back_and_forth(offsets_)) {
    const double changes = std::abs(offsets_.back() - offsets_[offsets_.size() - 2]);
    reason_ = fmt::format(
        "goes back and forth and cannot stop: a step changes the offset by {:.3g}, and {:.3g} is accepted, "
        "which is less than half of that",
        changes, accepted_);
    return LoopState::stuck;
  }
  if (runs_away(offsets_)) {
    reason_ = fmt::format("runs away: the offset grew from {:.4g} to {:.4g} in {} steps",
                          offsets_[offsets_.size() - patience], offset, patience - 1);
    return LoopState::stuck;
  }
  move_ = std::copysign(step_, offset);
  return LoopState::moves;
}

LoopState ShrinkingSteps::take(double offset) {
  if (!offsets_.empty()) {
    const double last = offsets_.back();
    const bool is_over = offset * last < 0 && std::abs(offset) > 0.5 * std::abs(last);
    if (is_over || std::abs(offset) > std::abs(last)) share_ *= 0.5;
  }
  offsets_.push_back(offset);
  move_ = 0;
  if (std::abs(offset) <= accepted_) return LoopState::holds;
  if (runs_away(offsets_)) {
    reason_ = fmt::format("runs away: what is missing grew from {:.4g} to {:.4g} in {} steps",
                          offsets_[offsets_.size() - patience], offset, patience - 1);
    return LoopState::stuck;
  }
  move_ = std::clamp(share_ * offset, -largest_, largest_);
  return LoopState::moves;
}

}  // namespace flexura
