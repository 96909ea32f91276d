#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "flexura/control/contour_images.h"
#include "flexura/estimate/observation.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Returns the pixels of the arm's points at these shares of its length. They are on the image of the
/// estimated shape, moved across it onto the measured centerline.
[[nodiscard]] std::optional<Eigen::Matrix2Xd> measured_pixels(const Arm& arm, const ArmState& estimate,
                                                              const Observation& seen,
                                                              const std::vector<double>& shares);

/// Computes the points of the estimated shape's contours, moved along their normals onto the measured edges.
/// 2 columns per cross-section, as in contour.pixels; not numbers where that has none.
// NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
void measured_edges(const ContourImage& contour, const Observation& seen,
                    Eigen::Ref<Eigen::Matrix2Xd> pixels);

}  // namespace flexura
