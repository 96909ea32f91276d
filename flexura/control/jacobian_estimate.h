#pragma once

#include <Eigen/Core>

// Feature Jacobians learned while the arm moves, for when the model of arm or cameras is wrong
// (docs/control.md, eq. 21 and 22).
namespace flexura {

/// Broyden's rank-one update: J becomes the matrix nearest to itself that explains the last motion (C. G.
/// Broyden, 1965; for servoing: M. Jagersand, O. Fuentes, R. Nelson, 1997).
class BroydenEstimate {
 public:
  /// `share` in (0, 1] of each correction is taken; motions of the variables below `least` teach nothing.
  /// std::invalid_argument: numbers out of these ranges or not finite.
  explicit BroydenEstimate(Eigen::MatrixXd J, double share = 1, double least = 1e-6);

  /// Features by variables: as it was given, with what was learned.
  [[nodiscard]] const Eigen::MatrixXd& jacobian() const { return J_; }
  /// The variables moved by dx, the features by df. False: too small a motion, or numbers that are not
  /// finite; nothing is learned. std::invalid_argument for other sizes.
  bool learn(const Eigen::VectorXd& dx, const Eigen::VectorXd& df);

 private:
  Eigen::MatrixXd J_;
  double share_, least_;
};

/// Recursive least squares with forgetting: J is what explains all motions best, the older the less (L.
/// Ljung, "System Identification", 11.2).
class RecursiveEstimate {
 public:
  /// forgetting in (0, 1]: the weight of a motion falls by it with each that follows. `doubt` > 0: how little
  /// the first J is believed, in units of motion^-2; it is also the most that is ever doubted, so that
  /// nothing runs away while the arm stands. std::invalid_argument: numbers out of these ranges or not
  /// finite.
  explicit RecursiveEstimate(Eigen::MatrixXd J, double forgetting = 0.95, double doubt = 1e4,
                             double least = 1e-6);

  [[nodiscard]] const Eigen::MatrixXd& jacobian() const { return J_; }
  /// As BroydenEstimate's.
  bool learn(const Eigen::VectorXd& dx, const Eigen::VectorXd& df);

 private:
  Eigen::MatrixXd J_, P_;
  double forgetting_, doubt_, least_;
};

}  // namespace flexura
