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

/// Simulates a distributed arm under the artificial potential, from rest (docs/control.md, eq. 6 and 9). The
/// law uses the arm's exact angles or measurements. With measurements, the potential's force and the
/// compensation of gravity and elasticity use the last measured shape and stay constant until the next
/// measurement. With two image planes, the potential's force uses the plane errors (eq. 14). The damping
/// always uses the arm's true rates, because the drives themselves produce the damping. With few drives, the
/// force on the arm is the producible force that is nearest to the law's force.
class PotentialRun {
 public:
  /// `start`: coordinates of the arm at the start, where it is at rest. `drives`: the matrix G
  /// (section_drives.h); empty: every point is driven. Throws std::invalid_argument for sizes that do not fit
  /// the arm, and for numbers that are not finite.
  PotentialRun(const DistributedArm& arm, const PotentialLaw& law, const Eigen::VectorXd& start,
               const std::optional<AngleMeasurement>& measurement = {}, const OdeTolerance& tolerance = {},
               const Eigen::MatrixXd& drives = {});
  PotentialRun(const PotentialRun&) = delete;  // The motion's force refers to it.
  PotentialRun& operator=(const PotentialRun&) = delete;

  /// Advances to the time `until`, s. The integrator calls go_on() before every step and stops if go_on()
  /// returns false. An empty go_on never stops the integration. Returns false if the run stopped before
  /// `until`. Then stopped() returns the reason ("cancelled" if go_on() stopped it).
  [[nodiscard]] bool advance(double until, const std::function<bool()>& go_on = {});
  /// Returns why the run cannot continue, or "".
  [[nodiscard]] const std::string& stopped() const { return stopped_; }

  /// Returns the current time, coordinates and rates, and the arm in this state.
  [[nodiscard]] const DistributedMotion& motion() const { return motion_; }
  /// Returns the largest difference between the law's force and the drives' force so far, as a share of the
  /// law's largest force.
  [[nodiscard]] double left_over() const { return largest_ > 0 ? left_over_ / largest_ : 0; }
  /// Returns PlaneObserver::triangulated; 0 if the law does not use two planes.
  [[nodiscard]] double triangulated() const { return planes_ ? planes_->triangulated() : 0; }
  /// Returns the current energies. If elasticity is shaped, `potential` includes V_e, and `elastic` is 0.
  [[nodiscard]] LyapunovSample sample() const;

 private:
  double force(const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
               Eigen::VectorXd& Q);
  [[nodiscard]] std::string reason() const;
  void measure();

  PotentialLaw law_;
  std::optional<MeasuredCoordinates> measured_;
  std::optional<PlaneObserver> planes_;
  Eigen::MatrixXd
      given_;  // Projection G G^+ of a force on what the drives produce. Empty: they produce any force.
  Eigen::VectorXd desired_;             // The law's force before this projection.
  double largest_ = 0, left_over_ = 0;  // |Q|, |Q - G G^+ Q|.
  DistributedArm seen_;                 // Set to the last measured shape.
  Eigen::VectorXd seen_x_;              // Coordinates of seen_.
  DistributedMotion motion_;
  std::string stopped_;
};

}  // namespace flexura
