#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/board/board_bundle.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Settings of a camera calibration from views of a board.
struct IntrinsicsConfig {
  int distortion = 5;  ///< Number of estimated coefficients of k1, k2, p1, p2, k3; the others are 0.
  int hold_out = 0;    ///< Every Nth view is held out of the fit and only predicted; 0: no views.
};

/// One camera's lens, estimated from views of a board.
struct CameraFit {
  Intrinsics lens;
  /// Of the intrinsics, in the order of `intrinsics_count`; 0 for those that are not estimated. Scaled by the
  /// residuals, assuming independent pixels.
  Eigen::Matrix<double, intrinsics_count, intrinsics_count> covariance;
  double rms = 0;        ///< Root mean square of the distances in its pictures, px.
  double rms_alone = 0;  ///< Root mean square of the distances when it is calibrated alone, px.
  /// Root mean square by view, px, including held-out ones; empty if it saw no board.
  std::vector<std::optional<double>> view_rms;
  /// Standard deviation of the image position of a direction, px, in the worst corner of the image. It is
  /// large if boards do not come near the corners.
  double corner_sigma = 0;
  /// The undetermined intrinsics. A standard deviation of one moves observed points by more than a hundredth
  /// of the image's diagonal. Corners count as accurate to a twentieth of a pixel at best. Or, if
  /// corner_sigma is larger than that hundredth, it moves the image's corners that far.
  std::vector<int> undetermined;

  /// Returns the standard deviation of one, by its index in the order of `intrinsics_count`, in its unit.
  [[nodiscard]] double sigma(int parameter) const;
};

/// Result of a joint calibration of cameras fixed to each other.
struct IntrinsicsFit {
  bool is_found = false;
  std::string reason;              ///< Why it failed.
  std::vector<CameraFit> cameras;  ///< Cameras in the order of the given sizes.
  std::vector<Pose> poses;         ///< X_1C: each camera in the first one.
  /// Of the small motion [v; w] of X_1C (p + v, exp(w) R); 0 for the first.
  std::vector<Eigen::Matrix<double, 6, 6>> pose_covariance;
  double rms = 0;                      ///< Root mean square of the distances in all fitted pictures, px.
  double noise = 0;                    ///< Standard deviation of one coordinate of a pixel, px.
  std::size_t points = 0;              ///< Number of fitted pixels.
  std::vector<bool> is_held_out;       ///< Whether a view was held out, by view.
  std::optional<double> held_out_rms;  ///< Root mean square of the distances in held-out views, px, with only
                                       ///< their boards fitted.
  std::vector<std::optional<Pose>> boards;  ///< X_1B by view.
  int steps = 0;                            ///< Steps of the joint fit.
};

/// Calibrates cameras of the given image sizes (width, height) from views of a board with `points` (z = 0 in
/// B). Each is calibrated alone, by Zhang's closed form (Z. Zhang, 2000) and least squares. Then all are
/// fitted together with their relative poses. Each camera needs at least two views that are not parallel;
/// cameras other than the first need one together with the first. Throws std::invalid_argument for views with
/// another number of cameras or points, or unless 0 to 5 coefficients of distortion are estimated.
[[nodiscard]] IntrinsicsFit fit_intrinsics(std::span<const Eigen::Vector2d> points,
                                           std::span<const BoardView> views,
                                           std::span<const std::array<int, 2>> sizes,
                                           const IntrinsicsConfig& config = {});

}  // namespace flexura
