#pragma once

#include <Eigen/Core>

#include "flexura/math/dense.h"

namespace flexura {

/// Returns off^T covariance^-1 off (P. C. Mahalanobis, 1936). For normal errors with this covariance it is
/// chi^2 distributed with as many degrees of freedom as components. NaN if the covariance is not positive
/// definite.
inline double mahalanobis_square(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& off) {
  return Cholesky(covariance).solve_lower(off).squaredNorm();
}

}  // namespace flexura
