#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Linear least squares fit of an arm's shape to places along the arm. The fit finds the change of the arm's
/// variables that moves these places by given displacements, with the least sum of squared errors. An arc
/// affects the arcs distal of it only by the twist of its end. So the normal equations are eliminated arc by
/// arc from the tip, and time and memory are linear in the number of arcs. The elimination is the Riccati
/// recursion of linear-quadratic regulators (Bryson, Ho, Applied Optimal Control, 1975, sec. 2.3 and 5.3).
class ArcFit {
 public:
  /// `places` are places on the arm of `variables`, in the order of their arcs.
  ArcFit(const ArmVariables& variables, std::vector<MaterialPoint> places);

  /// Linearises at a state. Throws std::invalid_argument if the state does not fit the arm.
  void set(const Arm& arm, const ArmState& state);
  /// Returns the position of a place in the state, in W, m.
  [[nodiscard]] Eigen::Vector3d position(std::size_t place) const { return positions_[place]; }
  /// Returns the best change of the variables (ArmVariables) for the displacements `moved` of the places in
  /// W, m. `moved` has 3 rows per place, and one column per problem. The result is variables x columns. If
  /// `reached` is not null, it is set to the displacements that the best change causes.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& moved, Eigen::MatrixXd* reached = nullptr) const;

 private:
  using Matrix36 = Eigen::Matrix<double, 3, 6>;
  using Matrix66 = Eigen::Matrix<double, 6, 6>;
  using Columns = BackboneJacobian::Columns;

  // A place, and its velocity per twist of its arc's base and per rate of its arc's variables.
  struct Spot {
    Matrix36 by_base;
    Eigen::Matrix3d by_own;
  };
  // Twists [v; w] are of the arc's base and end themselves, in W.
  struct Arc {
    std::size_t first = 0, count = 0;         // Its places.
    Matrix66 end_by_base = Matrix66::Zero();  // As one rigid body.
    Columns end_by_own = Columns::Zero();
    Matrix36 coupling = Matrix36::Zero();           // Of its variables to its base's twist.
    Eigen::LDLT<Eigen::Matrix3d> information = {};  // Of its variables, all arcs after it being free.
  };
  [[nodiscard]] Columns masked(Columns columns, std::size_t arc) const;
  void stand(const Arm& arm, const ArmState& state);

  std::vector<ArmVariables::Part> parts_;
  Eigen::Index size_;
  std::vector<MaterialPoint> places_;
  std::vector<Arm> single_;                  // Each arc as an arm, where it is.
  std::vector<BackboneJacobian> jacobians_;  // Of these.
  ArmState single_state_ = ArmState::straight(1);
  std::vector<Arc> arcs_;
  std::vector<Spot> spots_;
  std::vector<Eigen::Vector3d> positions_;
};

}  // namespace flexura
