#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Observation of a marker: a coloured band around the arm, or a spot on the arm.
struct MarkerObservation {
  /// For a band: image of the backbone point in the middle of the band, px. For a spot: centre of its visible
  /// part, px. A spot can be anywhere around the arm, so it does not determine a position on the backbone.
  Eigen::Vector2d pixel = {0, 0};
  /// Distance along the centerline from its first sample to the point nearest to `pixel`, px.
  double along = 0;
  /// Distance of `pixel` from the centerline, along the centerline's normal, px; 0 for bands.
  double aside = 0;
  double length = 0;  ///< Length along the centerline, px.
  double sigma = 0;   ///< Standard deviation of `along`, px.
  /// The edges of a band are circles around the arm, so their images are arcs. This is the height of these
  /// arcs along the centerline, in half widths of the arm. It equals the sine of the angle between the arm
  /// and the image plane. It is positive if the arm approaches the camera in the direction from base to tip.
  double bulge = 0;
  /// Red, green and blue of the marker's middle, from 0 to 255. In a gray picture, all three are the gray
  /// value.
  Eigen::Vector3d color = {0, 0, 0};
  /// Whether the marker is a band, which is visible across the whole arm; otherwise it is a spot.
  bool is_band = true;
  /// Whether the marker is probably two markers in one: it is much longer than others, or has two parts.
  bool may_be_merged = false;

  /// Returns whether the marker determines a position on the backbone. Spots and possibly merged markers do
  /// not.
  [[nodiscard]] bool determines_place() const { return is_band && !may_be_merged; }
};

/// All observed markers of an arm.
struct MarkerObservations {
  std::vector<MarkerObservation> markers;  ///< Markers from base to tip.
  std::vector<std::string>
      notes;  ///< Messages about gaps in which a marker may be missing, and about omitted candidates.
};

/// Finds the markers on an arm in `picture` (gray, or red, green, blue) by their difference from the arm's
/// own colour. In a gray picture, bands are found by their brightness. `arm` must be the observation of the
/// arm in the same picture. `with_spots`: whether to search spots too. This search covers the whole visible
/// surface and takes several times as long as the search for bands. The result is empty for a centerline with
/// fewer than 8 samples. It is also empty, with a note, for an arm thinner than 4 px.
[[nodiscard]] MarkerObservations find_markers(const Image<std::uint8_t>& picture, const ArmObservation& arm,
                                              bool with_spots = true);

}  // namespace flexura
