#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/camera/view.h"

namespace flexura {

/// A point where the backbone is seen.
struct CurvePoint {
  Eigen::Vector2d pixel = {0, 0};  ///< px
  double sigma = 0.1;              ///< Standard deviation across the curve, px; > 0.
  /// Standard deviation of what the points of a long stretch are off by together, beside that, px.
  double offset = 0;
};

/// How far along the curve the errors of an axis's points go together: the correlation of two is
/// exp(-distance / reach), distances in px. Of points that are measured each for itself: not at all.
struct ErrorReach {
  double sigma = 0;     ///< Of what CurvePoint::sigma says, px; 0: each is wrong by itself.
  double offset = 120;  ///< Of CurvePoint::offset, px; > 0.
};

/// A marker whose place on the arm is known.
struct SeenMarker {
  Eigen::Vector2d pixel = {0, 0};  ///< Where the backbone is seen at its middle.
  double s = 0;                    ///< Of its middle, m along the unstretched arm.
  double sigma = 0.1;              ///< px, in each direction; > 0.
};

/// A coloured band around the arm, wherever on it that is.
struct SeenBand {
  Eigen::Vector2d pixel = {0, 0};     ///< Where the backbone is seen in its middle.
  Eigen::Vector2d heading = {1, 0};   ///< Unit: the way in which the curve goes on there.
  double sigma = 0.2;                 ///< Standard deviation along the curve, px; > 0.
  Eigen::Vector3d color = {0, 0, 0};  ///< Red, green, blue, of 0 to 255.
};

/// Where an end of the arm is seen.
struct SeenEnd {
  Eigen::Vector2d pixel = {0, 0};  ///< px
  double sigma = 0.3;              ///< Standard deviation along the curve, px; > 0.
};

/// A point of the arm's silhouette.
struct SeenBorder {
  Eigen::Vector2d pixel = {0, 0};  ///< px
  double sigma = 0.5;              ///< Standard deviation across the border, px; > 0.
};

/// What a camera's view may be wrong by, as far as pictures of an arm can tell it from where the camera is:
/// its frame is turned by exp(turn), its focal lengths are those of the view times exp(focal).
struct ViewError {
  Eigen::Vector3d turn = {0, 0, 0};  ///< About the axes of the optical frame as it is believed to be, rad.
  double focal = 0;                  ///< The logarithm of the factor on both focal lengths.
};

/// The view without its error.
[[nodiscard]] View corrected(View view, const ViewError& error);

/// What one camera sees of an arm's backbone.
struct Sighting {
  View view;                       ///< As the camera is believed to stand.
  std::vector<CurvePoint> points;  ///< Along the arm, in the order from base to tip where that is known.
  /// The base and the tip; none where the arm goes on unseen (out of the picture, behind something).
  std::array<std::optional<SeenEnd>, 2> ends;
  std::vector<SeenMarker> markers;   ///< Those that were recognised.
  std::vector<SeenBand> bands = {};  ///< In any order; which is which the estimator finds out.
  ViewDoubt doubt = {};              ///< In the view.
  /// Points of the silhouette where no axis was found, in any order: of arms of known radius.
  std::vector<SeenBorder> borders = {};
  /// The two edges of the tube where both are seen: right of the way from base to tip as the picture shows
  /// it, then left; as measured, not where the backbone is.
  std::array<std::vector<CurvePoint>, 2> edges = {};
  ErrorReach reach = {};  ///< Of the points' errors.
  /// Places strewn over the figure that the arm is, px; none where it is not known.
  std::vector<Eigen::Vector2d> figure = {};
  /// Whether the lens has no ray for some of the arm's pixels: these are left out.
  bool leaves_out = false;
};

/// Whether each of them shows the arm, and one of them its axis: where a picture has no axis, the border of
/// what it shows is enough.
[[nodiscard]] bool are_enough(std::span<const Sighting> sightings);

/// The same, followed from the other end.
[[nodiscard]] Sighting reversed(Sighting sighting);

/// At most `most` points of a curve, evenly taken, the first and the last among them.
[[nodiscard]] std::vector<CurvePoint> thinned(const std::vector<CurvePoint>& points, std::size_t most);

/// The same sighting with so many points at most, and as many of the borders and of each edge.
[[nodiscard]] Sighting thinned(Sighting sighting, std::size_t most);

}  // namespace flexura
