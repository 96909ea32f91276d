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
  /// Additional standard deviation of the error common to the points of a long stretch, px.
  double offset = 0;
};

/// Correlation of the errors of an axis's points along the curve: exp(-distance / reach), distances in px.
/// Individually measured points are independent.
struct ErrorReach {
  double sigma = 0;     ///< Reach of the errors of CurvePoint::sigma, px; 0: independent.
  double offset = 120;  ///< Reach of the errors of CurvePoint::offset, px; > 0.
};

/// A marker at a known position on the arm.
struct SeenMarker {
  Eigen::Vector2d pixel = {0, 0};  ///< Image of the backbone at its middle.
  double s = 0;                    ///< Position of its middle, m along the unstretched arm.
  double sigma = 0.1;              ///< Standard deviation in each direction, px; > 0.
};

/// A coloured band around the arm at an unknown position.
struct SeenBand {
  Eigen::Vector2d pixel = {0, 0};     ///< Image of the backbone in its middle.
  Eigen::Vector2d heading = {1, 0};   ///< Unit direction of the curve there.
  double sigma = 0.2;                 ///< Standard deviation along the curve, px; > 0.
  Eigen::Vector3d color = {0, 0, 0};  ///< Red, green, blue, from 0 to 255.
};

/// Image of an end of the arm.
struct SeenEnd {
  Eigen::Vector2d pixel = {0, 0};  ///< Image position, px.
  double sigma = 0.3;              ///< Standard deviation along the curve, px; > 0.
};

/// A point of the arm's silhouette.
struct SeenBorder {
  Eigen::Vector2d pixel = {0, 0};  ///< Image position, px.
  double sigma = 0.5;              ///< Standard deviation across the border, px; > 0.
};

/// Error of a camera's view that pictures of an arm can determine for a known camera position. The true frame
/// is rotated by exp(turn); the true focal lengths are those of the view times exp(focal).
struct ViewError {
  Eigen::Vector3d turn = {0, 0, 0};  ///< About the axes of the modelled optical frame, rad.
  double focal = 0;                  ///< Logarithm of the factor on both focal lengths.
};

/// Returns the view corrected by its error.
[[nodiscard]] View corrected(View view, const ViewError& error);

/// Observation of an arm's backbone by one camera.
struct Observation {
  View view;                       ///< View as modelled.
  std::vector<CurvePoint> points;  ///< Points along the arm, from base to tip if that is known.
  /// Base and tip; empty if the arm continues unseen (out of the picture, behind something).
  std::array<std::optional<SeenEnd>, 2> ends;
  std::vector<SeenMarker> markers;   ///< Identified markers.
  std::vector<SeenBand> bands = {};  ///< Bands in any order; the estimator identifies them.
  ViewPrior view_prior = {};         ///< Prior of the view's error.
  /// Points of the silhouette where no axis was found, in any order; for arms of known radius.
  std::vector<SeenBorder> borders = {};
  /// The two edges of the tube where both are visible: right of the direction from base to tip in the
  /// picture, then left. They are as measured, without correction to the backbone.
  std::array<std::vector<CurvePoint>, 2> edges = {};
  ErrorReach reach = {};  ///< Reach of the points' errors.
  /// Sample points of the arm's foreground, px; empty if not known.
  std::vector<Eigen::Vector2d> figure = {};
  /// Whether the lens has no ray for some of the arm's pixels; these are omitted.
  bool leaves_out = false;
};

/// Returns whether each of them shows the arm, and at least one its axis. In a picture without an axis the
/// border is enough.
[[nodiscard]] bool are_enough(std::span<const Observation> observations);

/// Returns the observation in the order from the other end.
[[nodiscard]] Observation reversed(Observation observation);

/// Returns at most `most` points of a curve, evenly spaced, including the first and the last.
[[nodiscard]] std::vector<CurvePoint> thinned(const std::vector<CurvePoint>& points, std::size_t most);

/// Returns the observation with at most `most` points, borders, and points of each edge.
[[nodiscard]] Observation thinned(Observation observation, std::size_t most);

}  // namespace flexura
