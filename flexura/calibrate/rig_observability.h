#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// Information of the observations on one of the rig's own variables.
struct RigKnowledge {
  std::string name;             ///< "front: mount, x"
  double prior = 0, sigma = 0;  ///< Standard deviations before and after, in the variable's unit.
  bool is_determined = false;   ///< Whether sigma is at most half of the prior.
};

/// A combination of the rig's own variables that the observations hardly determine. Changing them together,
/// in these shares of their priors, changes almost nothing observable.
struct UnobservableDirection {
  double share = 0;   ///< Remaining share of the prior standard deviation: near 1, nothing was learned.
  std::string words;  ///< "front: pupil, z (-0.71) with front: tilt axis, z (+0.70)"
};

/// What observations determine of a rig, and what they do not.
struct RigObservability {
  std::vector<RigKnowledge> numbers;  ///< Variables in the order of x.
  std::vector<UnobservableDirection>
      unobservable;  ///< Combinations whose sigma is over half of the prior's, largest first.
};

/// Evaluates a covariance of x for the rig's own variables. Those without a prior are compared with a
/// relevant size (RigVariables::Variable::scale).
[[nodiscard]] RigObservability observability(const RigVariables& variables,
                                             const Eigen::MatrixXd& covariance);

}  // namespace flexura
