#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// Information of the observations on one of the rig's own variables.
struct RigKnowledge {
  std::string name;  ///< Name of the variable, such as "front: mount, x".
  double prior = 0,
         sigma = 0;  ///< Standard deviations before and after the observations, in the variable's unit.
  bool is_determined = false;  ///< Whether sigma is at most half of the prior.
};

/// A combination of the rig's own variables that the observations hardly determine. Changing them together,
/// in these shares of their priors, changes almost nothing observable.
struct UnobservableDirection {
  double share =
      0;  ///< Remaining share of the prior standard deviation; near 1 the observations determine nothing.
  std::string words;  ///< Description, such as "front: pupil, z (-0.71) with front: tilt axis, z (+0.70)".
};

/// Which variables of a rig the observations determine, and which combinations they do not determine.
struct RigObservability {
  std::vector<RigKnowledge> numbers;                ///< The rig's own variables, in the order of x.
  std::vector<UnobservableDirection> unobservable;  ///< Combinations whose standard deviation exceeds half of
                                                    ///< the prior's, the largest first.
};

/// Determines from the covariance of all variables x how well the rig's own variables are known. A variable
/// without a prior is compared with its typical size (RigVariables::Variable::scale).
[[nodiscard]] RigObservability observability(const RigVariables& variables,
                                             const Eigen::MatrixXd& covariance);

}  // namespace flexura
