#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>

#include "flexura/control/distributed_arm.h"

namespace flexura {

/// Observes a distributed arm in two parallel projections and computes its errors from a target
/// (docs/control.md, eq. 14 and 15). Where the projections do not determine the errors (planes_determine) or
/// contradict each other (planes_contradict), points are triangulated from both pictures. At these points,
/// theta and q are measured directly, with equal noise.
class PlaneObserver {
 public:
  /// Makes an observer for arms that have the model of `arm`. `target`: coordinates of the target. `noise`:
  /// standard deviations of alpha_1 and alpha_2 at each of the points arm.shapes().s, rad.
  PlaneObserver(const DistributedArm& arm, const Eigen::VectorXd& target, const std::array<double, 2>& noise);

  /// Measures an arm that is set to the state x. `deviate(i)` returns noise with variance 1: first for
  /// alpha_1 at all points, then for alpha_2.
  void look(const DistributedArm& arm, const Eigen::VectorXd& x,
            const std::function<double(std::uint64_t i)>& deviate);

  /// Returns the errors of theta at the points in the last measurement, measured minus desired, rad.
  [[nodiscard]] const Eigen::VectorXd& e_theta() const { return e_theta_; }
  /// Returns the errors of q at the points in the last measurement, measured minus desired, rad.
  [[nodiscard]] const Eigen::VectorXd& e_q() const { return e_q_; }
  /// Returns the coordinates of the last measurement. The angles in these coordinates are the least-squares
  /// fit to the measured angles along the arm. The lengths in these coordinates are the true lengths.
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return coordinates_; }
  /// Returns the share of triangulated points in all measurements.
  [[nodiscard]] double triangulated() const;

 private:
  std::array<double, 2> noise_;
  Eigen::VectorXd theta_d_, q_d_;  // Angles of the target at the points.
  Eigen::VectorXd clamped_theta_,
      clamped_q_;        // Contribution of the clamped base to the angles at the points.
  Eigen::MatrixXd fit_;  // Maps an angle's values at the points to its coordinates.
  Eigen::VectorXd theta_, q_, e_theta_, e_q_, coordinates_;
  double determined_ = 0, undetermined_ = 0;  // Numbers of points over all measurements.
};

}  // namespace flexura
