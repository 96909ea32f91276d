#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// A coloured band around the arm, or a spot on it.
struct MarkerSighting {
  /// A band: where the backbone is seen in its middle. A spot: the centre of what is seen of it, wherever on
  /// the skin that is; nothing is known of the backbone there.
  Eigen::Vector2d pixel = {0, 0};
  double along = 0;   ///< Way along the axis from its first sample to the foot of `pixel`, px.
  double aside = 0;   ///< From there to `pixel` along the axis's normal, px; 0 for bands.
  double length = 0;  ///< Along the axis, px.
  double sigma = 0;   ///< Standard deviation of `along`, px.
  /// How far the band's front bulges along the axis, in half widths of the arm: the sine of the angle by
  /// which the arm is turned out of the picture's plane, positive where it comes towards the camera from base
  /// to tip.
  double bulge = 0;
  Eigen::Vector3d color = {
      0, 0, 0};         ///< Red, green, blue of its middle, of 0 to 255; a gray picture's three times.
  bool is_band = true;  ///< Seen across the arm; otherwise a spot.
  /// Much longer than others, or of two parts: probably two in one.
  bool may_be_merged = false;

  /// It tells of a place on the backbone: a spot has no known one, and what may be two is neither.
  [[nodiscard]] bool tells_place() const { return is_band && !may_be_merged; }
};

/// All that was seen of an arm's markers.
struct MarkerSightings {
  std::vector<MarkerSighting> markers;  ///< From the base on.
  std::vector<std::string> notes;       ///< Of gaps where one may be missing, and what was left out.
};

/// The markers along an arm that was found in `picture` (gray, or red, green, blue): what differs from the
/// arm's own colour. In a gray picture bands show by their brightness. Spots are looked for all over the
/// skin, which takes several times as long as bands alone; what may have been one is left out of the notes
/// without. `arm` was found in this very picture. None of an axis of fewer than 8 samples, nor (with a note)
/// of an arm thinner than 4 px.
[[nodiscard]] MarkerSightings find_markers(const Image<std::uint8_t>& picture, const ArmSighting& arm,
                                           bool with_spots = true);

}  // namespace flexura
