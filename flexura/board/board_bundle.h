#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// What cameras that stand still to each other saw of a board at one time: for each camera the pixels of the
/// board's points, in the board's order; none where it saw no board. (Of a camera that never sees one nothing
/// is told: it stays as it was.)
struct BoardView {
  std::vector<std::vector<Eigen::Vector2d>> pixels;  ///< (u, v), px.
};

/// What a set of views is explained by.
struct BoardBundle {
  std::vector<Intrinsics> lenses;  ///< A camera each.
  std::vector<Pose> cameras;       ///< X_1C: each camera in the first; the first is where it is.
  std::vector<Pose> boards;        ///< X_1B: each view's board in the first camera.
};

/// What of a bundle is fitted.
struct BundleConfig {
  bool cameras = true;        ///< Lenses and cameras, and not the boards alone.
  int distortion = 5;         ///< How many of k1, k2, p1, p2, k3; the others keep their values.
  int most_steps = 100;       ///< Of BundleFit::steps.
  double least_gain = 1e-12;  ///< A step that gains less than this share of the sum is the last.
};

/// A bundle fitted to views.
struct BundleFit {
  BoardBundle bundle;
  bool is_converged = false;  ///< Else no step helped, or they ran out.
  int steps = 0;              ///< The first linearization, and every step tried.
  double square_sum = 0;      ///< Of all pixels' distances, px^2.
  std::size_t points = 0;     ///< Pixels that were compared.
  std::size_t unknowns = 0;   ///< Cameras' and boards'.
  /// Of the cameras' unknowns, the boards' eliminated, for noise of 1 px: its inverse is their covariance.
  /// Camera by camera its lens, in the order of `intrinsics_count` as far as it is fitted; then for each
  /// camera but the first its small motion [v; w] of X_1C: p + v, exp(w) R.
  Eigen::MatrixXd information;
};

/// Least squares of the distances between `views` and the images of `points` (z = 0 in B), in all cameras and
/// views at once, from a start; by Levenberg's and Marquardt's method. A board's six unknowns appear in its
/// own view only, so the boards are eliminated from each step (Schur complement; D. C. Brown's bundle
/// adjustment), which costs a time in proportion to the number of views. Where a start shows a point nowhere,
/// the fit has not converged and is the start.
[[nodiscard]] BundleFit fit_bundle(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                                   const BoardBundle& start, const BundleConfig& config);

/// The sum of squared distances in one view and camera, px^2; none where the lens shows a point nowhere.
[[nodiscard]] std::optional<double> square_sum(std::span<const Eigen::Vector2d> points, const BoardView& view,
                                               const BoardBundle& bundle, std::size_t camera,
                                               const Pose& X_1B);

}  // namespace flexura
