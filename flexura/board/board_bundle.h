#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// One view of a board by cameras fixed to each other. For each camera it has the pixels of the board's
/// points, in the board's order; empty if it saw no board. (A camera that never sees one keeps its values.)
struct BoardView {
  std::vector<std::vector<Eigen::Vector2d>> pixels;  ///< (u, v), px.
};

/// Unknowns that explain a set of views.
struct BoardBundle {
  std::vector<Intrinsics> lenses;  ///< One per camera.
  std::vector<Pose> cameras;       ///< X_1C: each camera in the first; that of the first stays fixed.
  std::vector<Pose> boards;        ///< X_1B: each view's board in the first camera.
};

/// What is fitted in a bundle.
struct BundleConfig {
  bool cameras = true;  ///< Whether lenses and camera poses are fitted, in addition to the boards.
  int distortion = 5;  ///< Number of fitted coefficients of k1, k2, p1, p2, k3; the others keep their values.
  int most_steps = 100;       ///< Limit of BundleFit::steps.
  double least_gain = 1e-12;  ///< The fit ends when a step gains less than this share of the sum.
};

/// Result of a fit.
struct BundleFit {
  BoardBundle bundle;
  bool is_converged = false;  ///< Otherwise no step helped, or the limit was reached.
  int steps = 0;              ///< The first linearisation, and every step tried.
  double square_sum = 0;      ///< Sum of all pixels' squared distances, px^2.
  std::size_t points = 0;     ///< Number of pixels compared.
  std::size_t unknowns = 0;   ///< Number of unknowns of cameras and boards.
  /// Information matrix of the cameras' unknowns, with the boards' eliminated, for noise of 1 px; its inverse
  /// is their covariance. For each camera first the fitted part of its lens, in the order of
  /// `intrinsics_count`. Then, for each camera except the first, its small motion [v; w] of X_1C: p + v,
  /// exp(w) R.
  Eigen::MatrixXd information;
};

/// Fits a bundle by least squares of the distances between `views` and the images of `points` (z = 0 in B),
/// in all cameras and views at once. Uses the Levenberg-Marquardt method from `start`. A board's six unknowns
/// appear in its own view only. The boards are therefore eliminated from each step (Schur complement; D. C.
/// Brown's bundle adjustment), at a cost proportional to the number of views. If the start does not show a
/// point, the result is the start, not converged.
[[nodiscard]] BundleFit fit_bundle(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                                   const BoardBundle& start, const BundleConfig& config);

/// Returns the sum of squared distances in one view and camera, px^2; empty if the lens does not show a
/// point.
[[nodiscard]] std::optional<double> square_sum(std::span<const Eigen::Vector2d> points, const BoardView& view,
                                               const BoardBundle& bundle, std::size_t camera,
                                               const Pose& X_1B);

}  // namespace flexura
