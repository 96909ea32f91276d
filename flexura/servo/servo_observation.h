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
  ArmState desired;  ///< Target at that time.
  /// For targets from recorded pictures: their offset from what nominal cameras would observe, in the law's
  /// features; empty: zero.
  Eigen::VectorXd desired_offset;
  std::array<Frame, 2> frames;         ///< Of both cameras.
  std::array<Observation, 2> seen;     ///< Centerlines, bands, borders; views corrected by their errors.
  ShapeEstimate estimate;              ///< Shape of the arm at that time.
  /// Shape of the arm without its swing about the equilibrium; equal to that of `estimate` for an arm that
  /// does not swing.
  ArmState rest;
  std::array<std::string, 2> reasons;  ///< Reason why a picture shows no arm, or "".
};

}  // namespace flexura
