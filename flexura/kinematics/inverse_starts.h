#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "flexura/kinematics/arm_variables.h"

namespace flexura {

/// Start states for the descents of inverse kinematics. The first is the given state, the second is one arc
/// to the target, and all others are random states within the limits (SplitMix64). Equal inputs give equal
/// start states.
class InverseStarts {
 public:
  /// `p_BT`: target of the tip in the base's frame, m. `first`: variables of the given state.
  InverseStarts(const ArmVariables& variables, const Eigen::Vector3d& p_BT,
                std::optional<Eigen::VectorXd> first, std::uint64_t seed);

  /// Sets x to the next start, within the limits.
  void next(Eigen::VectorXd& x);

 private:
  void one_arc(Eigen::VectorXd& x) const;
  void anywhere(Eigen::VectorXd& x, double widest_start);
  double random();

  const ArmVariables& variables_;
  Eigen::Vector3d p_BT_;
  std::optional<Eigen::VectorXd> first_;
  bool arc_is_next_ = true;
  bool wide_is_next_ = false;
  std::uint64_t random_state_;
};

}  // namespace flexura
