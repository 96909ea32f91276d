#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace flexura {

/// A marker whose place on the arm is known.
struct KnownMarker {
  double s = 0;                       ///< Of its middle, m along the unstretched arm.
  Eigen::Vector3d color = {1, 1, 1};  ///< Red, green, blue; their ratios count.
};

/// What is expected or seen along an arm in a picture: markers in their order, and the arm's two ends.
struct MarkerScene {
  struct Place {
    Eigen::Vector2d pixel = {0, 0};
    Eigen::Vector3d color = {1, 1, 1};
  };
  std::vector<std::optional<Place>> markers;           ///< None: not to be seen.
  std::array<std::optional<Eigen::Vector2d>, 2> ends;  ///< Base and tip, where they are seen; px.
};

/// Which of the expected markers each seen one is; none for what is nothing's.
struct MarkerMatch {
  std::vector<std::optional<std::size_t>> markers;
  bool is_reversed = false;  ///< What was seen runs from the tip to the base.
  std::size_t count = 0;     ///< Markers that were recognised.

  bool operator==(const MarkerMatch&) const = default;
};

/// How far off from what is expected a picture may be as a whole: standard deviations.
struct MatchDoubt {
  double shift = std::numeric_limits<double>::infinity();  ///< px
  double turn = std::numeric_limits<double>::infinity();   ///< rad
  double scale = std::numeric_limits<double>::infinity();  ///< Of the logarithm.
};

/// Recognises markers by their pattern: the expected picture is moved, turned (up to 45 degrees) and scaled
/// (by half to twice) until as much as possible of what is seen falls on something of its kind, where ends
/// are of another kind than markers and markers of different colours are of different kinds. What is seen and
/// not expected counts against a match, what is expected inside an image of `size` px and not seen counts by
/// half, and moves that `doubt` makes unlikely by half their square: a chain of equal markers is not taken
/// for the same shifted by one. Of equal matches the one whose points lie nearer, then the one found first.
[[nodiscard]] MarkerMatch match_markers(const MarkerScene& expected, const MarkerScene& seen,
                                        const std::array<int, 2>& size, const MatchDoubt& doubt = {});

}  // namespace flexura
