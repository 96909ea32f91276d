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
  double s = 0;                       ///< Position of its middle, m along the unstretched arm.
  Eigen::Vector3d color = {1, 1, 1};  ///< Red, green, blue; only their ratios matter.
};

/// Features along an arm in a picture, expected or seen: markers in order and the two ends.
struct MarkerScene {
  struct Place {
    Eigen::Vector2d pixel = {0, 0};
    Eigen::Vector3d color = {1, 1, 1};
  };
  std::vector<std::optional<Place>> markers;           ///< Empty: not visible.
  std::array<std::optional<Eigen::Vector2d>, 2> ends;  ///< Base and tip, px; empty if not visible.
};

/// The identity of each seen marker; empty for a false detection.
struct MarkerMatch {
  std::vector<std::optional<std::size_t>> markers;
  bool is_reversed = false;  ///< Whether the seen markers run from tip to base.
  std::size_t count = 0;     ///< Number of identified markers.

  bool operator==(const MarkerMatch&) const = default;
};

/// Prior standard deviations of the motion of a whole picture relative to the expected one.
struct MatchPrior {
  double shift = std::numeric_limits<double>::infinity();  ///< Shift, px.
  double turn = std::numeric_limits<double>::infinity();   ///< Rotation, rad.
  double scale = std::numeric_limits<double>::infinity();  ///< Logarithm of the scale.
};

/// Identifies markers by their pattern. The expected picture is shifted, rotated (up to 45 degrees) and
/// scaled (by half to twice) until most seen features coincide with one of their kind. Ends and markers are
/// of different kinds, and so are markers of different colours. A seen feature that is not expected counts
/// against a match. An expected one inside an image of `size` px that is not seen counts by half. Motions
/// count by half the square of their size in standard deviations of `match_prior`. This prevents matching a
/// chain of equal markers shifted by one. Of equal matches the one with the smaller distances wins, then the
/// one found first.
[[nodiscard]] MarkerMatch match_markers(const MarkerScene& expected, const MarkerScene& seen,
                                        const std::array<int, 2>& size, const MatchPrior& match_prior = {});

}  // namespace flexura
