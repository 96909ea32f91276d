#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/board/board_bundle.h"
#include "flexura/board/lens_misfit.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Settings of a camera calibration from views of a board.
struct IntrinsicsConfig {
  LensModel model = LensModel::brown;  ///< Lens model of all cameras.
  /// Number of estimated distortion coefficients, in the order of the lens model; the others are 0. Default:
  /// all coefficients of the model.
  std::optional<int> distortion = {};
  /// N = hold_out: every Nth view is excluded from the fit and only predicted; 0: all views are fitted.
  int hold_out = 0;
  /// Orders of the board's points in which the board looks the same (BoardTarget::equal_orders()); empty: one
  /// order. If there are several, cameras may count the points differently. The order that all common views
  /// agree on is used. The fit fails if a second order fits, too.
  std::vector<std::vector<std::size_t>> orders = {};
};

/// Lens of one camera, estimated from views of a board.
struct CameraFit {
  Intrinsics lens;
  /// Covariance of the intrinsics, in the order of `intrinsics_count`; 0 for intrinsics that are not
  /// estimated. The covariance is scaled by the residuals, which are assumed to be independent.
  Eigen::Matrix<double, intrinsics_count, intrinsics_count> covariance;
  double rms = 0;  ///< Root mean square of the distances between observed and computed pixels in the camera's
                   ///< fitted pictures, px.
  /// Root mean square of the distances between observed and computed pixels if the camera is calibrated
  /// alone, px.
  double rms_alone = 0;
  /// Root mean square of the distances between observed and computed pixels in each view, including held-out
  /// views, px. Missing for views in which the camera did not see the board.
  std::vector<std::optional<double>> view_rms;
  /// Standard deviation of the image position of a direction, px, in the worst corner of the image. The value
  /// is large if no board was near the corners.
  double corner_sigma = 0;
  /// Indices of undetermined intrinsics. An intrinsic parameter is undetermined if a change by one standard
  /// deviation moves observed points by more than 1 % of the image's diagonal. If corner_sigma exceeds this
  /// distance, a parameter that moves the corners by over 1 % is also undetermined. The error of observed
  /// pixels is assumed to be at least 0.05 px.
  std::vector<int> undetermined;

  LensMisfit misfit;  ///< Structure of the residuals in the fitted views.

  /// Returns the standard deviation of an intrinsic parameter, in its unit. `parameter` is the index in the
  /// order of `intrinsics_count`.
  [[nodiscard]] double sigma(int parameter) const;
};

/// Result of the joint calibration of cameras that are fixed to each other.
struct IntrinsicsFit {
  bool is_found = false;           ///< Whether the calibration succeeded.
  std::string reason;              ///< Reason why the calibration failed.
  std::vector<CameraFit> cameras;  ///< Cameras in the order of the given sizes.
  std::vector<Pose> poses;         ///< Pose X_1C of each camera relative to the first camera.
  /// Covariance of the small motion [v; w] of each pose X_1C (p + v, exp(w) R); 0 for the first camera.
  std::vector<Eigen::Matrix<double, 6, 6>> pose_covariance;
  double rms = 0;    ///< Root mean square of the distances between observed and computed pixels in all fitted
                     ///< pictures, px.
  double noise = 0;  ///< Standard deviation of one coordinate of an observed pixel, px.
  std::size_t points = 0;         ///< Number of observed pixels that were fitted.
  std::vector<bool> is_held_out;  ///< Whether the view was held out, for each view.
  /// Root mean square of the distances in held-out views, px. In these views, only the boards' poses are
  /// fitted.
  std::optional<double> held_out_rms;
  std::vector<std::optional<Pose>>
      boards;     ///< Pose X_1B of the board relative to the first camera, for each view.
  int steps = 0;  ///< Number of steps of the joint fit.
};

/// Calibrates cameras from views of a board with `points` (z = 0 in B, m). `sizes` has the width and height
/// of each camera's images, px. First calibrates each camera alone, by Zhang's closed form (Z. Zhang, 2000)
/// and least squares. Then fits all cameras together with their relative poses. Each camera needs at least
/// two views in which the board is not parallel. Each camera except the first also needs a view in which the
/// first camera saw the board. Throws std::invalid_argument for views with a wrong number of cameras or
/// points, and for a number of distortion coefficients that the lens model does not have.
[[nodiscard]] IntrinsicsFit fit_intrinsics(std::span<const Eigen::Vector2d> points,
                                           std::span<const BoardView> views,
                                           std::span<const std::array<int, 2>> sizes,
                                           const IntrinsicsConfig& config = {});

}  // namespace flexura
