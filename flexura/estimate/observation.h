#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/camera/view.h"

namespace flexura {

/// An image point of the backbone.
struct CurvePoint {
  Eigen::Vector2d pixel = {0, 0};  ///< Image position, px.
  double sigma = 0.1;              ///< Standard deviation across the curve, px; > 0.
  /// Standard deviation of an additional error that is nearly equal in neighbouring points, px.
  double offset = 0;
};

/// Correlation lengths of the errors of points along a measured axis. The correlation of two points' errors
/// is exp(-distance / length), with distance and length in px. Individually measured points have independent
/// errors.
struct ErrorReach {
  double sigma = 0;  ///< Correlation length of the error with CurvePoint::sigma, px; 0: independent errors.
  double offset = 120;  ///< Correlation length of the error with CurvePoint::offset, px; > 0.
};

/// A marker at a known position on the arm.
struct SeenMarker {
  Eigen::Vector2d pixel = {0, 0};  ///< Image of the backbone at the marker's middle, px.
  double s = 0;                    ///< Arc length of the marker's middle on the unstretched arm, m.
  double sigma = 0.1;              ///< Standard deviation of the pixel in each direction, px; > 0.
};

/// A coloured band around the arm at an unknown position.
struct SeenBand {
  Eigen::Vector2d pixel = {0, 0};     ///< Image of the backbone at the band's middle, px.
  Eigen::Vector2d heading = {1, 0};   ///< Unit direction of the curve at this pixel.
  double sigma = 0.2;                 ///< Standard deviation along the curve, px; > 0.
  Eigen::Vector3d color = {0, 0, 0};  ///< Red, green and blue, from 0 to 255.
};

/// Image of an end of the arm.
struct SeenEnd {
  Eigen::Vector2d pixel = {0, 0};  ///< Image position, px.
  double sigma = 0.3;              ///< Standard deviation along the curve, px; > 0.
};

/// A point of the arm's silhouette.
struct SeenBorder {
  Eigen::Vector2d pixel = {0, 0};  ///< Image position, px.
  double sigma = 0.5;              ///< Standard deviation perpendicular to the border, px; > 0.
};

/// Error of a camera's view. Pictures of an arm determine this error if the camera's position is known. The
/// true camera frame is the modelled frame, rotated by exp(turn). The true focal lengths are the modelled
/// ones times exp(focal).
struct ViewError {
  Eigen::Vector3d turn = {0, 0, 0};  ///< Rotation vector in the modelled optical frame, rad.
  double focal = 0;                  ///< Logarithm of the factor on both focal lengths.
};

/// Returns the view corrected by its error.
[[nodiscard]] View corrected(View view, const ViewError& error);

/// Observation of an arm's backbone by one camera.
struct Observation {
  View view;                       ///< View as modelled.
  std::vector<CurvePoint> points;  ///< Points along the arm, ordered from base to tip if the order is known.
  /// Base and tip. An end that is outside the picture or hidden is missing.
  std::array<std::optional<SeenEnd>, 2> ends;
  std::vector<SeenMarker> markers;   ///< Identified markers.
  std::vector<SeenBand> bands = {};  ///< Bands in any order; the estimator identifies them.
  ViewPrior view_prior = {};         ///< Prior of the view's error.
  /// Points of the silhouette where no axis was found, in any order. These points are used for arms with
  /// known radius.
  std::vector<SeenBorder> borders = {};
  /// The two edges of the tube, where both are visible. In the picture, the first edge is right of the
  /// direction from base to tip, and the second is left. The edges are measured points of the tube, not of
  /// the backbone.
  std::array<std::vector<CurvePoint>, 2> edges = {};
  ErrorReach reach = {};  ///< Correlation lengths of the points' errors.
  /// Sample points of the arm's foreground, px; empty if not known.
  std::vector<Eigen::Vector2d> figure = {};
  /// Whether pixels of the arm were omitted because the lens has no ray for them.
  bool leaves_out = false;
};

/// Returns whether an estimate is possible: each observation shows the arm, and at least one shows the arm's
/// axis. An observation without an axis needs points of the silhouette.
[[nodiscard]] bool are_enough(std::span<const Observation> observations);

/// Returns the observation with its points in reverse order along the arm.
[[nodiscard]] Observation reversed(Observation observation);

/// Returns at most `most` points of a curve, evenly spaced, including the first and the last.
[[nodiscard]] std::vector<CurvePoint> thinned(const std::vector<CurvePoint>& points, std::size_t most);

/// Returns the observation with at most `most` axis points, `most` borders, and `most` points on each edge.
[[nodiscard]] Observation thinned(Observation observation, std::size_t most);

}  // namespace flexura
