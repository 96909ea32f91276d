#include "flexura/kinematics/friction_play.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/kinematics/tendons.h"

namespace flexura {

FrictionPlay::FrictionPlay(const Arm& arm, const Drive& drive, const ArmState& start)
    : arm_(arm),
      drive_(drive),
      is_exact_(!drive.loses_travel()),
      now_(tendon_displacements(arm, drive, start)),
      state_(start) {}

double FrictionPlay::half_travel(std::size_t axis, const std::vector<double>& wraps) const {
  return is_exact_ ? 0.0 : drive_.axes[axis].spool.friction_travel.value_or(0) * wraps[axis] / 2;
}

std::vector<double> FrictionPlay::spools() const {
  std::vector<double> result = now_.pulled;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += half_travel(i, now_.wraps);
  return result;
}

// The wraps depend on the shape, which depends on the wraps. Each iteration corrects the sections from the
// base to the tip. It contracts because the lost travel per radian is smaller than the tendons' radius.
const ArmState& FrictionPlay::follow(const std::vector<double>& spools) {
  if (spools.size() != drive_.axes.size())
    throw std::invalid_argument(
        fmt::format("{} spools for a drive with {} axes", spools.size(), drive_.axes.size()));
  if (is_exact_) {
    now_.pulled = spools;
    state_ = fit_state(arm_, drive_, now_).state;
    return state_;
  }
  constexpr int most_iterations = 200;
  constexpr double small = 1e-13;  // rad
  const std::vector<double> before = now_.pulled;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    for (std::size_t i = 0; i < spools.size(); ++i) {
      const double half = half_travel(i, now_.wraps);
      now_.pulled[i] = std::clamp(before[i], spools[i] - half, spools[i] + half);
    }
    state_ = fit_state(arm_, drive_, now_).state;
    std::vector<double> wraps = tendon_wraps(arm_, drive_, state_);
    double change = 0;
    for (std::size_t i = 0; i < wraps.size(); ++i)
      change = std::max(change, std::abs(wraps[i] - now_.wraps[i]) - small * wraps[i]);
    now_.wraps = std::move(wraps);
    if (change <= small) break;
  }
  return state_;
}

}  // namespace flexura
