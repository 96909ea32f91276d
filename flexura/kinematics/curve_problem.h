#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Residuals of the condition that the backbone follows a polyline, as functions of the vector x of
/// ArmVariables. The residuals compare points at evenly spaced fractions of the backbone's length with points
/// at equal fractions of the polyline's length. Each difference (x, y, z in base axes) is divided by `length`
/// and by the square root of the number of points. Hence |r|^2 is the mean square distance in units of
/// `length`.
class CurveProblem final : public BoundedProblem {
 public:
  /// `points`: vertices of the polyline in the base's frame, m. There must be at least two, not all equal.
  /// `length` is the scale of distances, m.
  CurveProblem(const ArmVariables& variables, const std::vector<Eigen::Vector3d>& points, double length);

  [[nodiscard]] Eigen::Index row_count() const override {
    return 3 * static_cast<Eigen::Index>(desired_.size());
  }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  /// Returns whether r is zero up to rounding, so that descents always fit the curve as well as possible.
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override { return r.squaredNorm() < 1e-26; }
  /// Returns the largest distance between points at equal fractions of the lengths of backbone and polyline,
  /// m, for the variables x. The points are all vertices of the polyline and many points in between, more
  /// than in the residuals.
  [[nodiscard]] double largest_distance(const Eigen::VectorXd& x);

  /// Returns the variables for which the end of each section is parallel to the polyline's tangent at an
  /// equal fraction of the length.
  [[nodiscard]] Eigen::VectorXd start_along_tangents() const;
  /// Returns the polyline's last point in the base's frame, m.
  [[nodiscard]] const Eigen::Vector3d& end() const { return desired_.back(); }

 private:
  /// A section in a state of the arm.
  struct Placed {
    Pose X_BS;
    Eigen::Vector2d bend;
    double stretch = 1.0;
    double s = 0.0;       // Arc length at the section's base, m.
    double length = 0.0;  // Length with stretch, m.
    Eigen::Vector3d end;
    Eigen::Matrix<double, 3, 2> linear, angular;  // Derivatives of the end's pose by the bend.
  };
  void place(const Eigen::VectorXd& x);
  void point_rows(double fraction, std::size_t section, Eigen::Index row, const Eigen::Vector3d& desired,
                  Eigen::VectorXd& r, Eigen::MatrixXd& J) const;
  [[nodiscard]] Eigen::Vector3d at(double fraction) const;
  [[nodiscard]] Eigen::Vector3d tangent_at(double fraction) const;

  const ArmVariables& variables_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> parts_;  // Fraction of the polyline's length up to each point.
  std::vector<Eigen::Vector3d> desired_;
  std::vector<Placed> placed_;
  double scale_;
};

}  // namespace flexura
