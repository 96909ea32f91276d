#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/mechanics/identification.h"

namespace flexura {

/// Which tendons have the coefficient of friction that is a parameter.
[[nodiscard]] std::vector<std::size_t> rubbing_tendons(const Rod& rod, const RodParameter& parameter);

/// The equations of motion of a record, integrated over windows: by_parameter x + fixed = 0 but for noise. To
/// first order in the coefficients of friction, around those of the rod.
struct IdentificationEquations {
  /// std::invalid_argument: as identify().
  IdentificationEquations(const Rod& rod, const std::vector<RodParameter>& parameters,
                          const RodMotionRecord& record, const IdentificationConfig& config);

  Eigen::MatrixXd by_parameter;  ///< Equations x parameters.
  Eigen::VectorXd fixed;
  Eigen::VectorXd nominal;  ///< Of the parameters, as the rod says.
  Eigen::VectorXd scales;   ///< Of the equations: what counts as one.

  [[nodiscard]] bool has_noise() const { return !covariances_.empty(); }
  /// Covariance of the noise of two columns, equations x equations: 0 is `fixed`, g + 1 parameter g.
  [[nodiscard]] const Eigen::MatrixXd& noise(Eigen::Index g, Eigen::Index h) const {
    return covariances_[static_cast<std::size_t>(g * (by_parameter.cols() + 1) + h)];
  }

 private:
  std::vector<Eigen::MatrixXd> covariances_;
};

}  // namespace flexura
