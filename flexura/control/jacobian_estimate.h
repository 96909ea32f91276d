#pragma once

#include <Eigen/Core>

// Feature Jacobians learned while the arm moves, for a wrong model of arm or cameras (docs/control.md, eq. 21
// and 22).
namespace flexura {

/// Broyden's rank-one update: each motion changes J to the nearest matrix that explains the motion (Broyden,
/// 1965; for servoing: Jagersand, Fuentes, Nelson, 1997).
class BroydenEstimate {
 public:
  /// `share` in (0, 1]: share of each correction that is applied. `least`: motions of the variables with a
  /// smaller norm are ignored. Throws std::invalid_argument for numbers that are out of range or not finite.
  explicit BroydenEstimate(Eigen::MatrixXd J, double share = 1, double least = 1e-6);

  /// Returns the derivatives of the features with respect to the variables: the initial J with all
  /// corrections.
  [[nodiscard]] const Eigen::MatrixXd& jacobian() const { return J_; }
  /// Learns from a motion of the variables by dx and of the features by df. Returns false and keeps J if the
  /// motion is too small or a number is not finite. Throws std::invalid_argument for sizes that do not fit J.
  bool learn(const Eigen::VectorXd& dx, const Eigen::VectorXd& df);

 private:
  Eigen::MatrixXd J_;
  double share_, least_;
};

/// Recursive least squares with forgetting: J is the least-squares fit to all motions, with smaller weights
/// for older motions (Ljung, "System Identification", 11.2).
class RecursiveEstimate {
 public:
  /// `forgetting` in (0, 1]: factor by which each new motion multiplies the weights of earlier motions.
  /// `max_variance` > 0: initial variance of J, in units of motion^-2. This variance is also an upper limit:
  /// without the limit, the covariance would grow without bound while the arm rests. Throws
  /// std::invalid_argument for numbers that are out of range or not finite.
  explicit RecursiveEstimate(Eigen::MatrixXd J, double forgetting = 0.95, double max_variance = 1e4,
                             double least = 1e-6);

  [[nodiscard]] const Eigen::MatrixXd& jacobian() const { return J_; }
  /// Learns from a motion. Arguments, result and exceptions are as for BroydenEstimate::learn.
  bool learn(const Eigen::VectorXd& dx, const Eigen::VectorXd& df);

 private:
  Eigen::MatrixXd J_, P_;
  double forgetting_, max_variance_, least_;
};

}  // namespace flexura
