#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// A quantity that is computed from a rig, with its gradient with respect to the rig's variables.
struct RigQuantity {
  std::string name;
  double value = 0;
  Eigen::VectorXd gradient;  ///< Derivative of the value with respect to x.

  /// Returns the quantity's standard deviation for a covariance of x.
  [[nodiscard]] double sigma(const Eigen::MatrixXd& covariance) const;
};

/// A stance to evaluate: an observed stance at its estimated position, or a planned stance. The uncertainty
/// of a planned stance includes the error of the head.
struct AskedStance {
  RigStance where;
  std::optional<std::size_t> observed;  ///< Index of the observed stance; empty if planned.
};
[[nodiscard]] AskedStance observed_stance(const RigVariables& variables, std::size_t stance);

/// The optical axis of a camera, from its pupil along C's z, in W.
struct OpticalAxis {
  Eigen::Matrix3d R_WC;
  Eigen::Vector3d pupil, direction;  ///< Position of the pupil (m) and unit direction of the axis, both in W.
  Eigen::Matrix<double, 3, Eigen::Dynamic> pupil_by_x, direction_by_x;
  double focal = 0;  ///< Focal length sqrt(fx fy) at the stance's zoom, px.
  Eigen::RowVectorXd log_focal_by_x;
};
[[nodiscard]] OpticalAxis optical_axis(const RigVariables& variables, const Eigen::VectorXd& x,
                                       const AskedStance& stance);

/// Returns the angle between two cameras' optical axes, rad in [0, pi].
[[nodiscard]] RigQuantity axes_angle(const OpticalAxis& a, const OpticalAxis& b);
/// Returns the distance between a camera's axis and a point of W, with components to the camera's right and
/// downwards, m.
[[nodiscard]] std::array<RigQuantity, 2> aim_errors(const OpticalAxis& axis, const Eigen::Vector3d& p_WP);
/// Returns the logarithm of the ratio of two cameras' magnifications at a point of W: `a` to `b`. A
/// magnification is the focal length divided by the point's depth.
[[nodiscard]] RigQuantity log_zoom_ratio(const OpticalAxis& a, const OpticalAxis& b,
                                         const Eigen::Vector3d& p_WP);
/// Returns the logarithm of the camera's focal length in px.
[[nodiscard]] RigQuantity log_focal(const OpticalAxis& axis);

}  // namespace flexura
