#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// A number that follows from a rig, and how it changes with the rig's variables.
struct RigQuantity {
  std::string name;
  double value = 0;
  Eigen::VectorXd gradient;  ///< By x.

  /// Its standard deviation, for a covariance of x.
  [[nodiscard]] double sigma(const Eigen::MatrixXd& covariance) const;
};

/// A stance to ask about: one of the observations', as it was in truth, or one that is only planned, of which
/// nothing is known beyond the rig: what its head does with the command adds to the uncertainty.
struct AskedStance {
  RigStance where;
  std::optional<std::size_t> observed;  ///< Number of the stance.
};
[[nodiscard]] AskedStance observed_stance(const RigVariables& variables, std::size_t stance);

/// The optical axis of a camera: from its pupil, along C's z; in W.
struct OpticalAxis {
  Eigen::Matrix3d R_WC;
  Eigen::Vector3d pupil, direction;  ///< m; unit.
  Eigen::Matrix<double, 3, Eigen::Dynamic> pupil_by_x, direction_by_x;
  double focal = 0;  ///< Root of fx fy as the zoom stands, px.
  Eigen::RowVectorXd log_focal_by_x;
};
[[nodiscard]] OpticalAxis optical_axis(const RigVariables& variables, const Eigen::VectorXd& x,
                                       const AskedStance& stance);

/// The angle between two cameras' optical axes, rad in [0, pi].
[[nodiscard]] RigQuantity axes_angle(const OpticalAxis& a, const OpticalAxis& b);
/// By how much a camera's axis passes a point of W: to the camera's right and downwards, m.
[[nodiscard]] std::array<RigQuantity, 2> aim_errors(const OpticalAxis& axis, const Eigen::Vector3d& p_WP);
/// Logarithm of how much larger `a` shows what is at a point of W than `b`: focal lengths over depths.
[[nodiscard]] RigQuantity log_zoom_ratio(const OpticalAxis& a, const OpticalAxis& b,
                                         const Eigen::Vector3d& p_WP);
/// Logarithm of a focal length, px.
[[nodiscard]] RigQuantity log_focal(const OpticalAxis& axis);

}  // namespace flexura
