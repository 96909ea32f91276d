#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// How well the observations determine one of the rig's own variables.
struct RigKnowledge {
  std::string name;  ///< Name of the variable, such as "front: mount, x".
  double prior = 0,
         sigma = 0;  ///< Standard deviations before and after the observations, in the variable's unit.
  bool is_determined = false;  ///< Whether sigma is at most half of the prior.
};

/// A combination of the rig's own variables that the observations hardly determine: if the variables change
/// together in these shares of their priors, the observations hardly change.
struct UnobservableDirection {
  double share =
      /// Remaining share of the prior standard deviation. A value near 1 means that the observations do not
      /// determine the combination.
      0;
  std::string words;  ///< Description, such as "front: pupil, z (-0.71) with front: tilt axis, z (+0.70)".
};

/// States which variables of a rig the observations determine, and which combinations they do not determine.
struct RigObservability {
  std::vector<RigKnowledge> numbers;  ///< The rig's own variables, in the order of x.
  /// Combinations whose standard deviation exceeds half of the prior standard deviation, the largest first.
  std::vector<UnobservableDirection> unobservable;
};

/// Computes the observability of the rig's own variables from the covariance of all variables x. A variable
/// without a prior is compared with its typical size (RigVariables::Variable::scale).
[[nodiscard]] RigObservability observability(const RigVariables& variables,
                                             const Eigen::MatrixXd& covariance);

}  // namespace flexura
