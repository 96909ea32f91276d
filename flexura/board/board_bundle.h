#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// One view of a board by cameras that are fixed to each other.
struct BoardView {
  std::vector<std::vector<Eigen::Vector2d>>
      pixels;  ///< For each camera, the pixels (u, v) of the board's points, in the board's order, px; empty
               ///< if the camera did not see the board. Points that it did not see are NaN.
};

/// Returns whether a camera saw the point with this pixel.
[[nodiscard]] inline bool is_seen(const Eigen::Vector2d& pixel) { return pixel.allFinite(); }

/// Returns the number of points that a camera saw.
[[nodiscard]] std::size_t seen_points(std::span<const Eigen::Vector2d> pixels);

/// Unknowns of a bundle adjustment. A camera that never sees the board keeps its initial values.
struct BoardBundle {
  std::vector<Intrinsics> lenses;  ///< Intrinsics of each camera.
  std::vector<Pose>
      cameras;  ///< Pose X_1C of each camera relative to the first camera. The first pose is fixed.
  std::vector<Pose> boards;  ///< Pose X_1B of the board relative to the first camera, in each view.
};

/// Settings of a bundle adjustment.
struct BundleConfig {
  bool cameras = true;   ///< Whether lenses and camera poses are fitted in addition to the boards.
  int distortion = 5;    ///< Number of fitted distortion coefficients, in the order of the lens model; the
                         ///< others keep their values. At most the model's number of coefficients.
  int most_steps = 100;  ///< Limit of BundleFit::steps.
  /// The fit ends when a step decreases the sum of squares by less than this fraction.
  double least_gain = 1e-12;
  double exact = 1e-20;  ///< The fit also ends when the sum of squares per point is below this, px^2.
};

/// Result of a bundle adjustment.
struct BundleFit {
  BoardBundle bundle;  ///< Fitted unknowns.
  /// Whether the fit converged. False if no step decreased the sum of squares, or if the limit on steps was
  /// reached.
  bool is_converged = false;
  int steps = 0;             ///< Number of tried steps plus one for the first linearisation.
  double square_sum = 0;     ///< Sum of squared distances between observed and computed pixels, px^2.
  std::size_t points = 0;    ///< Number of observed pixels.
  std::size_t unknowns = 0;  ///< Number of unknowns of cameras and boards.
  /// Information matrix of the cameras' unknowns for noise of 1 px, with the boards' unknowns eliminated. The
  /// inverse of this matrix is the covariance. The first unknowns are the fitted intrinsics of each camera,
  /// in the order of `intrinsics_count`. For each camera except the first, the small motion [v; w] of X_1C
  /// follows: p + v, exp(w) R.
  Eigen::MatrixXd information;
};

/// Fits cameras and boards by bundle adjustment (D. C. Brown). Minimizes the squared distances between the
/// observed pixels in `views` and the computed pixels of `points`, over all cameras and views. The points are
/// in the board's plane (z = 0 in B). Uses the Levenberg-Marquardt method from `start`. The six unknowns of a
/// board affect only the board's view. Hence the Schur complement eliminates them from each step, at a cost
/// proportional to the number of views. If an observed point cannot be projected at the start, the result is
/// the start and is not converged.
[[nodiscard]] BundleFit fit_bundle(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                                   const BoardBundle& start, const BundleConfig& config);

/// Returns the sum of squared distances between observed and computed pixels in one view and camera, px^2;
/// empty if the lens cannot image a point.
[[nodiscard]] std::optional<double> square_sum(std::span<const Eigen::Vector2d> points, const BoardView& view,
                                               const BoardBundle& bundle, std::size_t camera,
                                               const Pose& X_1B);

}  // namespace flexura
