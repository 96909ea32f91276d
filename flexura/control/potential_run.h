#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

#include "flexura/control/angle_measurement.h"
#include "flexura/control/distributed_arm.h"
#include "flexura/control/lyapunov_monitor.h"
#include "flexura/control/plane_observer.h"
#include "flexura/control/potential_law.h"

namespace flexura {

/// A distributed arm under the artificial potential, from rest (docs/control.md, eq. 6 and 9). The law uses
/// the arm's exact angles or measurements. With measurements, the potential's force and the compensation of
/// gravity and elasticity are those of the last measured shape, held until the next one. With two image
/// planes the potential's force is that of the plane errors (eq. 14). The damping always uses the arm's true
/// rates: it is part of the drives. With few drives, the arm gets the nearest force to the law's that they
/// can produce.
class PotentialRun {
 public:
  /// `start`: coordinates, at rest. `drives`: G (section_drives.h); empty: every point is driven. Throws
  /// std::invalid_argument for a size that does not fit, or numbers that are not finite.
  PotentialRun(const DistributedArm& arm, const PotentialLaw& law, const Eigen::VectorXd& start,
               const std::optional<AngleMeasurement>& measurement = {}, const OdeTolerance& tolerance = {},
               const Eigen::MatrixXd& drives = {});
  PotentialRun(const PotentialRun&) = delete;  // The motion's force refers to it.
  PotentialRun& operator=(const PotentialRun&) = delete;

  /// Advances to the time `until`, s, while go_on(), called before every step of the integrator, returns
  /// true; empty: always. Returns false if it could not; stopped() then returns the reason ("cancelled" after
  /// go_on()), and the run stays where it ended.
  [[nodiscard]] bool advance(double until, const std::function<bool()>& go_on = {});
  /// Returns why it cannot continue, or "".
  [[nodiscard]] const std::string& stopped() const { return stopped_; }

  /// Returns the current time, coordinates and rates, and the arm in this state.
  [[nodiscard]] const DistributedMotion& motion() const { return motion_; }
  /// Returns the largest part of the law's force that the drives could not produce, share of the largest
  /// force.
  [[nodiscard]] double left_over() const { return largest_ > 0 ? left_over_ / largest_ : 0; }
  /// Returns PlaneObserver::triangulated; 0 if the law does not use two planes.
  [[nodiscard]] double triangulated() const { return planes_ ? planes_->triangulated() : 0; }
  /// Returns the current energies. If elasticity is shaped, V_e is part of Pi and 0 here.
  [[nodiscard]] LyapunovSample sample() const;

 private:
  double force(const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
               Eigen::VectorXd& Q);
  [[nodiscard]] std::string reason() const;
  void measure();

  PotentialLaw law_;
  std::optional<MeasuredCoordinates> measured_;
  std::optional<PlaneObserver> planes_;
  Eigen::MatrixXd given_;               // Produced part of a force: G G^+. Empty: all of it.
  Eigen::VectorXd desired_;             // A force before this projection.
  double largest_ = 0, left_over_ = 0;  // |Q|, |Q - G G^+ Q|.
  DistributedArm seen_;                 // Set to the last measured shape.
  Eigen::VectorXd seen_x_;              // Coordinates of seen_.
  DistributedMotion motion_;
  std::string stopped_;
};

}  // namespace flexura
