#pragma once

#include <string_view>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Moves a median axis to where the backbone is seen, exactly so for a tube of constant radius: the two
/// planes through the camera that touch the tube at arc length s lie evenly to both sides of the plane that
/// holds the camera and the backbone's tangent at s, so the backbone's direction is half-way between those of
/// the two borders, on the sphere around the camera and not in the picture (docs/vision.md). Samples with a
/// border for whose pixel the lens has no ray stay. Fewer than 3 samples stay as they are. Whether all have
/// rays.
bool to_backbone_image(const Lens& lens, std::vector<AxisSample>& axis);

/// Whether the lens has rays for both borders of a sample as it was measured.
[[nodiscard]] bool has_rays(const Lens& lens, const AxisSample& sample);

/// A median axis where the backbone is seen, as far as the lens tells.
struct BackboneAxis {
  std::vector<AxisSample> samples;  ///< As many as were measured.
  /// Of each sample: it, its neighbours and where it was moved have rays. The others stay on the tube's
  /// middle.
  std::vector<bool> is_backbone;

  [[nodiscard]] bool is_whole() const;
  /// The samples that are the backbone's.
  [[nodiscard]] std::vector<AxisSample> known() const;
};

/// Of an axis as it was measured. Where rays are lacking and fewer than three samples are seen and the
/// backbone's, none is.
[[nodiscard]] BackboneAxis backbone_axis(const Lens& lens, const std::vector<AxisSample>& axis);

/// What to say of one that is not whole.
inline constexpr std::string_view middle_in_places =
    "the camera's distortion has no ray for some pixels of the arm: there the axis is its middle";

/// The depth of the backbone at each sample of such an axis, along the optical axis, m, from the tube's width
/// and its radius, m: to first order in radius over distance squared. Not a number where the lens shows
/// nothing. std::invalid_argument: a radius that is not positive.
[[nodiscard]] std::vector<double> backbone_depths(const Lens& lens, const std::vector<AxisSample>& axis,
                                                  double radius);

}  // namespace flexura
