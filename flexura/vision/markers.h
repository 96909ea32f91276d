#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// A coloured band around the arm, or a spot on it.
struct MarkerObservation {
  /// Band: image of the backbone in its middle. Spot: centre of its visible part, anywhere on the skin; it
  /// gives no backbone position.
  Eigen::Vector2d pixel = {0, 0};
  double along = 0;   ///< Distance along the axis from its first sample to the foot of `pixel`, px.
  double aside = 0;   ///< Distance from there to `pixel` along the axis's normal, px; 0 for bands.
  double length = 0;  ///< Length along the axis, px.
  double sigma = 0;   ///< Standard deviation of `along`, px.
  /// Bulge of the band's front along the axis, in half widths of the arm. It is the sine of the angle between
  /// the arm and the picture's plane, positive if the arm approaches the camera from base to tip.
  double bulge = 0;
  /// Red, green, blue of its middle, of 0 to 255; in a gray picture its value three times.
  Eigen::Vector3d color = {0, 0, 0};
  bool is_band = true;  ///< Whether it is visible across the arm; otherwise a spot.
  /// Much longer than others, or of two parts: probably two in one.
  bool may_be_merged = false;

  /// Returns whether it gives a position on the backbone: spots do not, nor do possibly merged markers.
  [[nodiscard]] bool determines_place() const { return is_band && !may_be_merged; }
};

/// All observed markers of an arm.
struct MarkerObservations {
  std::vector<MarkerObservation> markers;  ///< Markers from the base on.
  std::vector<std::string> notes;  ///< About gaps where one may be missing, and about omitted candidates.
};

/// Finds the markers along an arm in `picture` (gray, or red, green, blue) by their difference from the arm's
/// own colour. In a gray picture bands are found by their brightness. The search for spots covers the whole
/// skin and takes several times as long as bands alone. Without it, possible spots are not in the notes.
/// `arm` must be from this very picture. Empty for an axis of fewer than 8 samples, and (with a note) for an
/// arm thinner than 4 px.
[[nodiscard]] MarkerObservations find_markers(const Image<std::uint8_t>& picture, const ArmObservation& arm,
                                              bool with_spots = true);

}  // namespace flexura
