#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// What observations tell of one of a rig's own numbers.
struct RigKnowledge {
  std::string name;             ///< "front: mount, x"
  double prior = 0, sigma = 0;  ///< Standard deviation before and after, in the number's unit.
  bool is_told = false;         ///< It is known at least twice as well as before.
};

/// A combination of a rig's own numbers of which the observations tell little: moving them together, in these
/// shares of their priors, changes next to nothing that was seen.
struct RigBlindness {
  double share = 0;   ///< Of the prior's standard deviation that is left: near 1, nothing was told.
  std::string words;  ///< "front: pupil, z (-0.71) with front: tilt axis, z (+0.70)"
};

/// What observations tell of a rig, and what they cannot.
struct RigObservability {
  std::vector<RigKnowledge> numbers;    ///< In the order of x.
  std::vector<RigBlindness> blindness;  ///< The blindest first; those of which over half is left.
};

/// What a covariance of x says of the rig's own numbers. Numbers without a prior are compared with a size
/// that matters (RigVariables::Variable::scale).
[[nodiscard]] RigObservability observability(const RigVariables& variables,
                                             const Eigen::MatrixXd& covariance);

}  // namespace flexura
