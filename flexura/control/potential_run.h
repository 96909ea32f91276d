#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

#include "flexura/control/angle_measurement.h"
#include "flexura/control/distributed_arm.h"
#include "flexura/control/lyapunov_monitor.h"
#include "flexura/control/plane_sight.h"
#include "flexura/control/potential_law.h"

namespace flexura {

/// A distributed arm under the artificial potential, from rest on (docs/control.md, eq. 6 and 9). Either the
/// law has the arm's angles, or it has measurements of them: then the potential's force and what compensates
/// gravity and elasticity are those of the shape as measured last, held from one measurement to the next. By
/// two image planes the potential's force is that of the plane errors (eq. 14). The damping is of the arm's
/// own rates in both cases: it is the drives'. Where a few drives are all there is, the arm gets the nearest
/// to the law's force that these can give.
class PotentialRun {
 public:
  /// `start`: coordinates, at rest. `drives`: G (section_drives.h); empty: every point is driven.
  /// std::invalid_argument: a size that does not fit, numbers that are not finite.
  PotentialRun(const DistributedArm& arm, const PotentialLaw& law, const Eigen::VectorXd& start,
               const std::optional<AngleMeasurement>& measurement = {}, const OdeTolerance& tolerance = {},
               const Eigen::MatrixXd& drives = {});
  PotentialRun(const PotentialRun&) = delete;  // The motion's force refers to it.
  PotentialRun& operator=(const PotentialRun&) = delete;

  /// Goes on to the time `until`, s, as long as go_on(), asked before every step of the integrator, says so;
  /// empty: it always does. False: it could not, and stopped() says why ("cancelled": it was told so); it
  /// then stands where it came to, and stays there.
  [[nodiscard]] bool advance(double until, const std::function<bool()>& go_on = {});
  /// Why it cannot go on; empty: it can.
  [[nodiscard]] const std::string& stopped() const { return stopped_; }

  /// Time, coordinates and rates now, and the arm set to them.
  [[nodiscard]] const DistributedMotion& motion() const { return motion_; }
  /// The most of the law's force that the drives could not give, share of the largest that it asked for.
  [[nodiscard]] double left_over() const { return largest_ > 0 ? left_over_ / largest_ : 0; }
  /// PlaneSight::triangulated; 0 where the law does not go by two planes.
  [[nodiscard]] double triangulated() const { return planes_ ? planes_->triangulated() : 0; }
  /// The energies now. Where elasticity is shaped V_e is part of Pi and 0 here.
  [[nodiscard]] LyapunovSample sample() const;

 private:
  double force(const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
               Eigen::VectorXd& Q);
  [[nodiscard]] std::string reason() const;
  void measure();

  PotentialLaw law_;
  std::optional<MeasuredCoordinates> measured_;
  std::optional<PlaneSight> planes_;
  Eigen::MatrixXd given_;               // What drives give of a force: G G^+. Empty: all of it.
  Eigen::VectorXd wanted_;              // A force before that.
  double largest_ = 0, left_over_ = 0;  // |Q|, |Q - G G^+ Q|
  DistributedArm seen_;                 // Set to the shape as measured last,
  Eigen::VectorXd seen_x_;              // which has these coordinates.
  DistributedMotion motion_;
  std::string stopped_;
};

}  // namespace flexura
