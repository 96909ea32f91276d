// The command nearest to the law's within the limits of a limiter.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "flexura/control/limiter.h"
#include "flexura/control/limiter_paths.h"
#include "flexura/math/nearest_point.h"
#include "flexura/model/arm_difference.h"
#include "flexura/safety/clearance_slope.h"
#include "flexura/safety/contact_watch.h"

namespace flexura {
namespace {

// Distance from a limit at which the nearest command stays, as a share of the limit: rounding must not break
// it.
constexpr double near_limit = 1 - 1e-7;
// The same, beyond the tolerance of nearest_point(), rad.
constexpr double inside = 2e-7;
// Differences for derivatives of motor positions, rad.
constexpr double small_bend = 1e-3;

}  // namespace

std::optional<ArmState> CommandLimiter::nearest(const ArmState& desired, bool keeps_clear) const {
  ConvexLimits limits;
  for (std::size_t i = 0; i < arm_.sections.size(); ++i) {
    const Section& section = arm_.sections[i];
    const ArmVariables::Part& part = variables_.parts()[i];
    const Eigen::Index size = part.is_spatial ? 2 : 1;
    limits.balls.push_back(
        {part.at, sent_.bends[i].head(size), std::max(0.0, section.max_bend_rate * config_.step - inside)});
    limits.balls.push_back({part.at, Eigen::VectorXd::Zero(size), std::max(0.0, section.max_bend - inside)});
    if (!part.is_stretchable) continue;
    const double way = near_limit * section.max_stretch_rate * config_.step;
    limits.bands.push_back({Eigen::VectorXd::Unit(variables_.size(), part.stretch_at()),
                            std::max(section.stretch_limits[0], sent_.stretches[i] - way),
                            std::min(section.stretch_limits[1], sent_.stretches[i] + way)});
  }
  if (config_.drive) add_motor_limits(limits);
  if (keeps_clear) add_clearances(desired, limits);
  const std::optional<Eigen::VectorXd> found = nearest_point(limits, variables_.pack(desired));
  if (!found) return std::nullopt;
  ArmState state = desired;
  variables_.state(*found, state);
  std::string ignored;
  return within_limits(state, ignored);  // Exactly.
}

// Speeds and accelerations until the next command. Positions and the braking after it are left to the plan.
void CommandLimiter::add_motor_limits(ConvexLimits& limits) const {
  const Eigen::VectorXd x = variables_.pack(sent_);
  const auto axes = static_cast<Eigen::Index>(config_.drive->axes.size());
  Eigen::MatrixXd slopes(axes, x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    ArmState sides[2] = {sent_, sent_};
    for (int side = 0; side < 2; ++side)
      variables_.state(x + (side == 0 ? small_bend : -small_bend) * Eigen::VectorXd::Unit(x.size(), j),
                       sides[side]);
    slopes.col(j) = (motors_at(sides[0]) - motors_at(sides[1])) / (2 * small_bend);
  }
  for (Eigen::Index i = 0; i < axes; ++i) {
    const StepperMotor& motor = config_.drive->axes[static_cast<std::size_t>(i)].motor;
    const double rate = last_step_.rates[i], swing = last_step_.swing[i],
                 change = near_limit * motor_acceleration(motor) * turning_time_ - 4 * std::abs(swing),
                 fastest = near_limit * motor_rate(motor) - std::abs(swing);
    const double lower = std::max(rate - change, -fastest), upper = std::min(rate + change, fastest);
    if (!(lower <= upper)) continue;  // Left to the plan.
    const double norm = slopes.row(i).norm();
    if (!(norm > 0)) continue;
    // As a share of the norm, so that bands are as well scaled as the balls.
    const double here = slopes.row(i).dot(x);
    limits.bands.push_back({slopes.row(i).transpose() / norm, (here + config_.step * lower) / norm,
                            (here + config_.step * upper) / norm});
  }
}

// The clearance from each object at the end of the braking path stays positive, linear about the present
// shape.
void CommandLimiter::add_clearances(const ArmState& desired, ConvexLimits& limits) const {
  const Actuation& actuation = model_.actuation();
  const ArmState shape = actuation.shape(sent_);
  const Eigen::VectorXd x = variables_.pack(sent_);
  // With evenly decreasing rates the way to rest is as long as half of its steps at the first rate.
  const double braking = 0.5 * (braking_steps(desired) + 1);
  // Objects farther away than this are out of reach.
  const double reach = 0.5 * model_.shaped().length();
  for (const ContactWatch& watch : *contacts_) {
    const auto slope = clearance_slope(watch, model_.shaped(), shape, reach);
    if (!slope) continue;
    Eigen::MatrixXd by_command;
    actuation.by_command(slope->by_state, sent_, by_command);
    BandLimit band{.normal = Eigen::VectorXd::Zero(x.size()),
                   .lower = 0,
                   .upper = std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < variables_.parts().size(); ++i) {
      const ArmVariables::Part& part = variables_.parts()[i];
      const auto column = 3 * static_cast<Eigen::Index>(i);
      band.normal[part.at] = by_command(0, column);
      if (part.is_spatial) band.normal[part.at + 1] = by_command(0, column + 1);
      if (part.is_stretchable) band.normal[part.stretch_at()] = by_command(0, column + 2);
    }
    if (!band.normal.allFinite()) continue;
    // Curvature of the distance and errors of its derivative are left a part of the clearance.
    constexpr double part = 0.8;
    band.lower = band.normal.dot(x) - part * std::max(0.0, slope->clearance - contact_tolerance) / braking;
    limits.bands.push_back(std::move(band));
  }
}

}  // namespace flexura
