#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "flexura/control/contour_images.h"
#include "flexura/estimate/observation.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Returns the pixels of the arm's points at the shares `shares` of its length. Computes the image of each
/// point on the estimated shape, and moves it perpendicular to the shape's image onto the measured
/// centerline. Returns std::nullopt if this is impossible for any point.
[[nodiscard]] std::optional<Eigen::Matrix2Xd> measured_pixels(const Arm& arm, const ArmState& estimate,
                                                              const Observation& seen,
                                                              const std::vector<double>& shares);

/// Computes the contour points of the estimated shape, moved along their normals onto the measured edges.
/// `pixels` has 2 columns per cross-section, in the order of contour.pixels. Columns are NaN where the
/// contour has no point.
// NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
void measured_edges(const ContourImage& contour, const Observation& seen,
                    Eigen::Ref<Eigen::Matrix2Xd> pixels);

}  // namespace flexura
