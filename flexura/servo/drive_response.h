#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "flexura/control/jacobian_estimate.h"
#include "flexura/servo/servo_config.h"

namespace flexura {

/// Learned matrix that maps motions of the drives to motions of the observed shape (docs/control.md, eq.
/// 21a). The matrix is the identity if the arm follows its model. The matrix hardly depends on the shape, so
/// what is learned from one motion is valid for all shapes. Derivatives of features with respect to the
/// drives are derivatives with respect to the shape times this matrix.
class DriveResponse {
 public:
  /// `variables`: number of the arm's variables. With ServoJacobian::model, the matrix remains the identity.
  DriveResponse(ServoJacobian how, Eigen::Index variables);

  /// Learns from the drives' measured position x and the observed shape y at the same time (bends in rad,
  /// stretches). Skips values that are not finite.
  void learn(const Eigen::VectorXd& x, const Eigen::VectorXd& y);
  [[nodiscard]] bool is_learned() const { return !std::holds_alternative<std::monostate>(estimate_); }
  /// Returns dy/dx.
  [[nodiscard]] const Eigen::MatrixXd& matrix() const;
  /// Returns the motion of the drives that causes the motion `dy` of the shape. Ignores singular directions
  /// of the matrix.
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
