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
  double s = 0;                       ///< Arc length of the marker's middle on the unstretched arm, m.
  Eigen::Vector3d color = {1, 1, 1};  ///< Red, green and blue; only their ratios matter.
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

/// Identification of seen markers.
struct MarkerMatch {
  /// Index of the expected marker for each seen marker; empty: false detection.
  std::vector<std::optional<std::size_t>> markers;
  bool is_reversed = false;  ///< Whether the seen markers are ordered from tip to base.
  std::size_t count = 0;     ///< Number of identified markers.

  bool operator==(const MarkerMatch&) const = default;
};

/// Prior standard deviations of the similarity that maps the whole expected picture to the seen picture.
struct MatchPrior {
  double shift = std::numeric_limits<double>::infinity();  ///< Shift, px.
  double turn = std::numeric_limits<double>::infinity();   ///< Rotation, rad.
  double scale = std::numeric_limits<double>::infinity();  ///< Logarithm of the scale.
};

/// Identifies markers by their pattern. The expected picture is shifted, rotated (up to 45 degrees) and
/// scaled (by 0.5 to 2). The score of a match is the number of seen features that are near an expected
/// feature of equal kind. Ends are one kind of features, and each marker colour is another kind. Each seen
/// feature that is not expected reduces the score by 1. Each expected feature that is not seen, but should be
/// inside an image of `size` px, reduces the score by 1/2. The score is also reduced by
/// d^2 / 2, where d is the size of the similarity transform in standard deviations of `match_prior`. This
/// prevents a match of equal markers that is shifted by one marker. Returns the match with the best score. Of
/// matches with equal scores, returns the match with the smaller distances; if these are equal too, the first
/// match.
[[nodiscard]] MarkerMatch match_markers(const MarkerScene& expected, const MarkerScene& seen,
                                        const std::array<int, 2>& size, const MatchPrior& match_prior = {});

}  // namespace flexura
