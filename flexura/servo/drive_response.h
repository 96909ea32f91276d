#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "flexura/control/jacobian_estimate.h"
#include "flexura/servo/servo_config.h"

namespace flexura {

/// How the shape that is seen follows what the drives say, learned on the way: the matrix of that, one where
/// the arm does what its model says (docs/control.md, eq. 21a). What the pictures show of a shape is geometry
/// and changes from shape to shape; the drives' part does so much less, and each motion teaches it for all of
/// them. So the derivatives of anything seen by the drives are its derivatives by the shape times this
/// matrix.
class DriveResponse {
 public:
  /// Of so many of the arm's variables. ServoJacobian::model learns nothing.
  DriveResponse(ServoJacobian how, Eigen::Index variables);

  /// The drives said x when the arm was seen in the shape y (rad; stretches). What is no number is passed
  /// over.
  void learn(const Eigen::VectorXd& x, const Eigen::VectorXd& y);
  [[nodiscard]] bool is_learned() const { return !std::holds_alternative<std::monostate>(estimate_); }
  /// dy/dx
  [[nodiscard]] const Eigen::MatrixXd& matrix() const;
  /// The drives' part of a motion of the shape; as far as the matrix is regular.
  [[nodiscard]] Eigen::VectorXd drives_for(const Eigen::VectorXd& dy) const;

 private:
  struct Seen {
    Eigen::VectorXd x, y;
  };
  Eigen::MatrixXd identity_;
  std::variant<std::monostate, BroydenEstimate, RecursiveEstimate> estimate_;
  std::optional<Seen> before_;
  Eigen::VectorXd dx_, foreseen_, missed_;
};

}  // namespace flexura
