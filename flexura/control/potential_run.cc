#include "flexura/control/potential_run.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

constexpr double quarter_turn = std::numbers::pi / 2;
constexpr double most_theta = 100;      // In rad.
constexpr double least_stretch = 0.01;  // A section's length over that at rest.

// Returns true where the two angles and the lengths are valid coordinates of an arm.
bool is_regular(const DistributedArm& arm) {
  return arm.q().cwiseAbs().maxCoeff() < quarter_turn && arm.stretch().minCoeff() > least_stretch &&
         arm.theta().cwiseAbs().maxCoeff() < most_theta;
}

}  // namespace

PotentialRun::PotentialRun(const DistributedArm& arm, const PotentialLaw& law, const Eigen::VectorXd& start,
                           const std::optional<AngleMeasurement>& measurement, const OdeTolerance& tolerance,
                           const Eigen::MatrixXd& drives)
    : law_(law),
      seen_(arm),
      motion_(
          arm,
          [this](double, const DistributedArm& now, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                 Eigen::VectorXd& Q) { return force(now, x, v, Q); },
          tolerance) {
  if (start.size() != arm.size() || !start.allFinite())
    throw std::invalid_argument("a run must start at finite coordinates of its arm");
  if (drives.size() > 0) {
    if (drives.rows() != arm.size() || !drives.allFinite())
      throw std::invalid_argument("a run's drives must fit its arm, in finite numbers");
    given_ = drives * pseudo_inverse(drives);
  }
  if (measurement) measured_.emplace(*measurement, arm.nodes());
  if (measurement && measurement->reading == AngleReading::planes)
    planes_.emplace(arm, law.target(), measurement->noise);
  motion_.start(start);
  if (!is_regular(motion_.arm())) stopped_ = reason();
}

double PotentialRun::force(const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                           Eigen::VectorXd& Q) {
  if (planes_ && seen_x_.size() > 0) {
    law_.force_of_errors(seen_, planes_->e_theta(), planes_->e_q(), seen_x_, v, Q);
  } else if (measured_ && seen_x_.size() > 0) {
    law_.force(seen_, seen_x_, v, Q);
  } else {
    law_.force(arm, x, v, Q);
  }
  if (given_.size() > 0) {
    desired_ = Q;
    Q.noalias() = given_ * desired_;
    largest_ = std::max(largest_, desired_.norm()), left_over_ = std::max(left_over_, (desired_ - Q).norm());
  }
  // No step goes beyond: the last one ends just before it.
  if (!is_regular(arm)) Q.setConstant(std::numeric_limits<double>::quiet_NaN());
  return law_.dissipation(v);
}

void PotentialRun::measure() {
  measured_->take(motion_.x(), motion_.v());
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(seen_.size());
  seen_x_ = measured_->seen();
  seen_.set(seen_x_, still);
  if (!planes_) return;
  planes_->look(seen_, seen_x_, [this](std::uint64_t i) { return measured_->deviate(i); });
  seen_x_ = planes_->coordinates();
  seen_.set(seen_x_, still);
}

bool PotentialRun::advance(double until, const std::function<bool()>& go_on) {
  bool is_cancelled = false;
  const auto goes_on = [&] {
    is_cancelled = go_on && !go_on();
    return !is_cancelled;
  };
  while (stopped_.empty() && motion_.time() < until) {
    double next = until;
    if (measured_) {
      if (motion_.time() >= measured_->next()) measure();
      next = std::min(until, measured_->next());
    }
    if (!motion_.advance(next, goes_on)) stopped_ = is_cancelled ? "cancelled" : reason();
  }
  return stopped_.empty();
}

// Returns why a motion ended: the coordinate nearest to its limit.
std::string PotentialRun::reason() const {
  constexpr double near = 0.99;
  const DistributedArm& arm = motion_.arm();
  Eigen::Index point = 0;
  if (arm.q().cwiseAbs().maxCoeff(&point) > near * quarter_turn)
    return fmt::format(
        "|q| reached 90 deg at {:.3f} s, {:.3f} m along the arm, where the two angles are singular",
        motion_.time(), arm.shapes().s[point]);
  if (arm.stretch().minCoeff() < least_stretch / near)
    return fmt::format("the length of a section became zero at {:.3f} s", motion_.time());
  if (arm.theta().cwiseAbs().maxCoeff() > near * most_theta)
    return fmt::format("the motion diverges: at {:.3f} s the arm was bent farther than is possible",
                       motion_.time());
  return fmt::format("after {:.3f} s the motion is too fast for the integration", motion_.time());
}

LyapunovSample PotentialRun::sample() const {
  const DistributedArm& arm = motion_.arm();
  const bool is_shaped = law_.gains().elasticity == ElasticityRule::shaped;
  return {.time = motion_.time(),
          .kinetic = arm.kinetic_energy(),
          .potential = law_.potential(arm, motion_.x()),
          .gravity = arm.gravity_energy(),
          .elastic = is_shaped ? 0 : arm.elastic_energy(),
          .taken = motion_.summed(),
          .damped = motion_.damped()};
}

}  // namespace flexura
