#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_prior.h"
#include "flexura/port/rig_model.h"

// The bundle as Ceres finds it: residuals written anew, with Ceres' own derivatives and rotations.
namespace flexura {

struct CeresBundle {
  bool is_settled = false;
  Eigen::VectorXd x;                  ///< In the order of RigVariables.
  Eigen::MatrixXd covariance;         ///< Of x.
  double cost = 0;                    ///< Prior included.
  std::vector<Eigen::Vector3d> axes;  ///< Each stance's optical axis in W.
};

/// The least of the same sum over markers, from the same guess: by squares first, then with residuals that
/// count linearly beyond `bound`. For cameras whose zoom is linear, arms of three sections and stances of
/// which pan and tilt alone may be off.
CeresBundle ceres_bundle(const RigModel& guess, const RigPrior& prior, const RigObservations& seen,
                         double bound);

}  // namespace flexura
