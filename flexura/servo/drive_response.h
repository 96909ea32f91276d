#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "flexura/control/jacobian_estimate.h"
#include "flexura/servo/servo_config.h"

namespace flexura {

/// Learned matrix that maps motions of the drives to motions of the observed shape (docs/control.md, eq.
/// 21a). The matrix is the identity if the arm follows its model. It hardly depends on the shape, unlike the
/// derivatives of image features, so each motion improves it for all shapes. The derivatives of features with
/// respect to the drives are their derivatives with respect to the shape, times this matrix.
class DriveResponse {
 public:
  /// `variables`: number of the arm's variables. With ServoJacobian::model nothing is learned.
  DriveResponse(ServoJacobian how, Eigen::Index variables);

  /// Learns from the drives' reading x and the shape y observed at that time (bends in rad, stretches). Skips
  /// values that are not finite.
  void learn(const Eigen::VectorXd& x, const Eigen::VectorXd& y);
  [[nodiscard]] bool is_learned() const { return !std::holds_alternative<std::monostate>(estimate_); }
  /// Returns dy/dx.
  [[nodiscard]] const Eigen::MatrixXd& matrix() const;
  /// Returns the motion of the drives for a motion of the shape, as far as the matrix is regular.
  [[nodiscard]] Eigen::VectorXd drives_for(const Eigen::VectorXd& dy) const;

 private:
  struct Seen {
    Eigen::VectorXd x, y;
  };
  Eigen::MatrixXd identity_;
  std::variant<std::monostate, BroydenEstimate, RecursiveEstimate> estimate_;
  std::optional<Seen> before_;
  Eigen::VectorXd dx_, predicted_, missed_;
};

}  // namespace flexura
