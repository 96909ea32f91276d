#pragma once

#include <string_view>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Moves a centerline to the image of the backbone (docs/vision.md). The result is exact for a tube of
/// constant radius. Two planes through the camera are tangent to the tube at arc length s. They are symmetric
/// about the plane through the camera and the backbone's tangent at s. Hence the viewing direction to the
/// backbone is the mean of the viewing directions to the two borders. In the picture, this is not the middle
/// between the borders. Samples remain unchanged if the lens has no ray for a border pixel, or if there are
/// fewer than 3 samples. Returns whether all samples have rays.
bool to_backbone_image(const Lens& lens, std::vector<AxisSample>& axis);

/// Returns whether the lens has rays for both borders of a measured sample.
[[nodiscard]] bool has_rays(const Lens& lens, const AxisSample& sample);

/// A centerline that was moved to the image of the backbone wherever the lens has rays.
struct BackboneAxis {
  std::vector<AxisSample> samples;  ///< Samples, one for each sample of the measured centerline.
  /// For each sample, whether it is on the backbone's image. This requires that the lens has rays for the
  /// sample, its neighbours and its new position. Other samples are in the middle of the tube's image.
  std::vector<bool> is_backbone;

  [[nodiscard]] bool is_whole() const;
  /// Returns the samples that are on the backbone's image.
  [[nodiscard]] std::vector<AxisSample> known() const;
};

/// Computes the centerline on the backbone's image from a measured centerline. If rays are missing and fewer
/// than three visible samples are on the backbone's image, `is_backbone` is false for all samples.
[[nodiscard]] BackboneAxis backbone_axis(const Lens& lens, const std::vector<AxisSample>& axis);

/// Message for a result for which BackboneAxis::is_whole() is false.
inline constexpr std::string_view middle_in_places =
    "the camera's distortion has no ray for some pixels of the arm: there the axis is its middle";

/// Returns the depth of the backbone along the optical axis at each sample, m. It is computed from the width
/// of the tube's image and the tube's radius, m. The result is exact to first order in (radius / distance)^2.
/// The depth is NaN for samples without a ray. Throws std::invalid_argument for a radius that is not
/// positive.
[[nodiscard]] std::vector<double> backbone_depths(const Lens& lens, const std::vector<AxisSample>& axis,
                                                  double radius);

}  // namespace flexura
