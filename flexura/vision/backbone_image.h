#pragma once

#include <string_view>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Moves a centerline to the image of the backbone, exactly for a tube of constant radius. Two planes through
/// the camera are tangent to the tube at arc length s. They are symmetric about the plane through the camera
/// and the backbone's tangent at s. Hence the backbone's direction is half-way between those of the two
/// borders, on the sphere around the camera and not in the picture (docs/vision.md). Samples with a border
/// pixel without a ray are unchanged, and so are fewer than 3 samples. Returns whether all samples have rays.
bool to_backbone_image(const Lens& lens, std::vector<AxisSample>& axis);

/// Returns whether the lens has rays for both borders of a measured sample.
[[nodiscard]] bool has_rays(const Lens& lens, const AxisSample& sample);

/// A centerline at the image of the backbone, as far as the lens determines it.
struct BackboneAxis {
  std::vector<AxisSample> samples;  ///< Samples, as many as were measured.
  /// By sample: whether it, its neighbours and its new position have rays. The others stay on the tube's
  /// middle.
  std::vector<bool> is_backbone;

  [[nodiscard]] bool is_whole() const;
  /// Returns the samples that lie on the backbone's image.
  [[nodiscard]] std::vector<AxisSample> known() const;
};

/// Computes it from a measured axis. If rays are missing and fewer than three samples are visible and on the
/// backbone's image, all samples count as not on it.
[[nodiscard]] BackboneAxis backbone_axis(const Lens& lens, const std::vector<AxisSample>& axis);

/// Message for an axis that is not whole.
inline constexpr std::string_view middle_in_places =
    "the camera's distortion has no ray for some pixels of the arm: there the axis is its middle";

/// Returns the depth of the backbone at each sample of such an axis, along the optical axis, m, from the
/// tube's width and its radius, m. Exact to first order in radius over distance squared. NaN where the lens
/// has no ray. Throws std::invalid_argument for a radius that is not positive.
[[nodiscard]] std::vector<double> backbone_depths(const Lens& lens, const std::vector<AxisSample>& axis,
                                                  double radius);

}  // namespace flexura
