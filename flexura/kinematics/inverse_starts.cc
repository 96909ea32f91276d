#include "flexura/kinematics/inverse_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace flexura {
namespace {

using std::numbers::pi;
// For sections without a limit, or a wider one: starts are bent up to these values in turn. Most targets need
// bends up to half a turn, and tightly rolled solutions are found only from rolled starts.
constexpr std::array<double, 2> widest_starts = {1.25 * pi, 2.0 * pi};

}  // namespace

InverseStarts::InverseStarts(const ArmVariables& variables, const Eigen::Vector3d& p_BT,
                             std::optional<Eigen::VectorXd> first, std::uint64_t seed)
    : variables_(variables), p_BT_(p_BT), first_(std::move(first)), random_state_(seed) {}

void InverseStarts::next(Eigen::VectorXd& x) {
  if (first_) {
    x = *first_;
    first_.reset();
  } else if (std::exchange(arc_is_next_, false)) {
    one_arc(x);
  } else {
    anywhere(x, widest_starts[wide_is_next_ ? 1 : 0]);
    wide_is_next_ = !wide_is_next_;
  }
  project(variables_.bounds(), x);
}

// The chord of an arc deviates from the tangent at its start by half the bend. The result is never exactly
// straight, because an exactly straight arm has no preferred side to bend to.
void InverseStarts::one_arc(Eigen::VectorXd& x) const {
  const double across = std::hypot(p_BT_.x(), p_BT_.y());
  const double bend = std::max(0.1, 2.0 * std::atan2(across, p_BT_.z()));
  Eigen::Vector2d towards(0.8, 0.6);
  if (across > 0.0) towards = p_BT_.head<2>() / across;
  const double length = variables_.max_length();
  for (const ArmVariables::Part& part : variables_.parts()) {
    const double share = bend * part.length * part.stretch_limits[1] / length;
    x[part.at] =
        share * (part.is_spatial || towards.x() >= 0.0 ? 1.0 : -1.0) * (part.is_spatial ? towards.x() : 1.0);
    if (part.is_spatial) x[part.at + 1] = share * towards.y();
    if (part.is_stretchable) x[part.stretch_at()] = 1.0;
  }
}

void InverseStarts::anywhere(Eigen::VectorXd& x, double widest_start) {
  for (const ArmVariables::Part& part : variables_.parts()) {
    const double widest = std::min(part.max_bend, widest_start);
    if (part.is_spatial) {
      const double radius = widest * std::sqrt(random());
      const double angle = 2.0 * pi * random();
      x[part.at] = radius * std::cos(angle);
      x[part.at + 1] = radius * std::sin(angle);
    } else {
      x[part.at] = widest * (2.0 * random() - 1.0);
    }
    if (part.is_stretchable) {
      const auto [low, high] = part.stretch_limits;
      x[part.stretch_at()] = low + (high - low) * random();
    }
  }
}

// SplitMix64 (Steele, Lea, Flood 2014), in [0, 1).
double InverseStarts::random() {
  random_state_ += 0x9E3779B97F4A7C15;
  std::uint64_t z = random_state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-53;
}

}  // namespace flexura
