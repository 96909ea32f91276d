#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/mechanics/identification.h"

namespace flexura {

/// Equations of motion of a record, integrated over windows: by_parameter x + fixed = noise. The equations
/// are linearised with respect to the friction coefficients, about the coefficients of the rod.
struct IdentificationEquations {
  /// Throws std::invalid_argument as identify().
  IdentificationEquations(const Rod& rod, const std::vector<RodParameter>& parameters,
                          const RodMotionRecord& record, const IdentificationConfig& config);

  Eigen::MatrixXd by_parameter;  ///< Equations x parameters.
  Eigen::VectorXd fixed;
  Eigen::VectorXd nominal;  ///< Parameters of the given rod.
  Eigen::VectorXd scales;   ///< Unit of each equation.

  [[nodiscard]] bool has_noise() const { return !covariances_.empty(); }
  /// Returns the covariance between the noise of columns g and h, equations x equations. Column 0 is `fixed`,
  /// and column i + 1 belongs to parameter i.
  [[nodiscard]] const Eigen::MatrixXd& noise(Eigen::Index g, Eigen::Index h) const {
    return covariances_[static_cast<std::size_t>(g * (by_parameter.cols() + 1) + h)];
  }

 private:
  std::vector<Eigen::MatrixXd> covariances_;
};

}  // namespace flexura
