#pragma once

#include <Eigen/Core>

#include "flexura/math/dense.h"

namespace flexura {

/// off^T covariance^-1 off (P. C. Mahalanobis, 1936), of vectors of any size: where errors are normal and
/// have that covariance, chi^2 of as many degrees of freedom as they have components. Not a number where the
/// covariance is not positive definite.
inline double mahalanobis_square(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& off) {
  return Cholesky(covariance).solve_lower(off).squaredNorm();
}

}  // namespace flexura
