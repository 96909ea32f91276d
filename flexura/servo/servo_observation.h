#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/model/arm.h"
#include "flexura/port/camera_port.h"

namespace flexura {

/// Observation from two simultaneous pictures.
struct ServoObservation {
  double time = 0;   ///< Middle of the exposures, s.
  ArmState desired;  ///< Target at the time of the observation.
  /// Features in the target's recorded pictures minus those that nominal cameras would observe; empty: zero.
  Eigen::VectorXd desired_offset;
  std::array<Frame, 2> frames;  ///< Frames of both cameras.
  std::array<Observation, 2>
      seen;                ///< Measured arm in each picture. The views include the estimated camera errors.
  ShapeEstimate estimate;  ///< Estimated shape of the arm at the time of the observation.
  /// Equilibrium shape of the arm, without its oscillation. For an arm without dynamics, the equilibrium
  /// shape equals the shape of `estimate`.
  ArmState rest;
  std::array<std::string, 2> reasons;  ///< Reason why a picture shows no arm, or "".
};

}  // namespace flexura
