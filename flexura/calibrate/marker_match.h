#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace flexura {

/// A marker with a known position on the arm.
struct KnownMarker {
  double s = 0;                       ///< Position of the marker's middle, m along the unstretched arm.
  Eigen::Vector3d color = {1, 1, 1};  ///< Red, green, blue; only their ratios matter.
};

/// Features of an arm in a picture, expected or seen: the markers in order along the arm, and the two ends.
struct MarkerScene {
  struct Place {
    Eigen::Vector2d pixel = {0, 0};
    Eigen::Vector3d color = {1, 1, 1};
  };
  std::vector<std::optional<Place>> markers;           ///< Markers in order; empty if not visible.
  std::array<std::optional<Eigen::Vector2d>, 2> ends;  ///< Base and tip, px; empty if not visible.
};

/// Identities of the seen markers.
struct MarkerMatch {
  std::vector<std::optional<std::size_t>> markers;  ///< Index of each seen marker; empty: a false detection.
  bool is_reversed = false;                         ///< Whether the seen markers run from tip to base.
  std::size_t count = 0;                            ///< Number of identified markers.

  bool operator==(const MarkerMatch&) const = default;
};

/// Prior standard deviations of the similarity that maps the whole expected picture to the seen picture.
struct MatchPrior {
  double shift = std::numeric_limits<double>::infinity();  ///< Shift, px.
  double turn = std::numeric_limits<double>::infinity();   ///< Rotation, rad.
  double scale = std::numeric_limits<double>::infinity();  ///< Logarithm of the scale.
};

/// Identifies markers by their pattern. The expected picture is shifted, rotated (up to 45 degrees) and
/// scaled (by 0.5 to 2). The best match has most seen features near an expected feature of their kind. Ends
/// and markers are of different kinds, and so are markers of different colours. The score of a match
/// decreases by 1 for each seen feature that is not expected. It decreases by 1/2 for each expected feature
/// inside an image of `size` px that is not seen. It decreases by half the squared similarity in standard
/// deviations of `match_prior`. This prevents a match of equal markers that is shifted by one marker. Of
/// matches with equal scores the one with the smaller distances is taken, then the one found first.
[[nodiscard]] MarkerMatch match_markers(const MarkerScene& expected, const MarkerScene& seen,
                                        const std::array<int, 2>& size, const MatchPrior& match_prior = {});

}  // namespace flexura
