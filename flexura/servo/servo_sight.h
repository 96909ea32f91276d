#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/sighting.h"
#include "flexura/model/arm.h"
#include "flexura/port/camera_port.h"

namespace flexura {

/// What two pictures of one instant told.
struct ServoSight {
  double time = 0;   ///< Middle of the exposures, s.
  ArmState desired;  ///< Then.
  /// How far goals that are recorded pictures lie from what the cameras, as they are believed to be, would
  /// see of that, in the law's own features; empty: nothing.
  Eigen::VectorXd desired_offset;
  std::array<Frame, 2> frames;   ///< Of both cameras.
  std::array<Sighting, 2> seen;  ///< Axes, bands and borders, in the views as believed, less their errors.
  ShapeEstimate estimate;        ///< Of the arm's shape at that time.
  std::array<std::string, 2> reasons;  ///< Why a picture shows no arm; "" when it does.
};

}  // namespace flexura
