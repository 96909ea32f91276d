#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_prior.h"
#include "flexura/port/rig_model.h"

// An independent bundle adjustment with Ceres: residuals reimplemented, with Ceres' derivatives and
// rotations.
namespace flexura {

struct CeresBundle {
  bool is_settled = false;
  Eigen::VectorXd x;                  ///< Estimated variables in the order of RigVariables.
  Eigen::MatrixXd covariance;         ///< Covariance of x.
  double cost = 0;                    ///< Cost including the prior.
  std::vector<Eigen::Vector3d> axes;  ///< Optical axis in W, by stance.
};

/// Minimises the same cost over markers from the same guess. It uses the squared loss first, then residuals
/// that count linearly beyond `bound`. Supports cameras with a linear zoom, arms of three sections, and
/// errors of the camera axes in pan and tilt only.
CeresBundle ceres_bundle(const RigModel& guess, const RigPrior& prior, const RigObservations& seen,
                         double bound);

}  // namespace flexura
