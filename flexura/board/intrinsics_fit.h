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

/// How cameras are calibrated from views of a board.
struct IntrinsicsConfig {
  int distortion = 5;  ///< How many of k1, k2, p1, p2, k3 are estimated; the others are 0.
  int hold_out = 0;    ///< Every so-manieth view is left out of the fit and only predicted; 0: none.
};

/// One camera's lens, as views of a board tell it.
struct CameraFit {
  Intrinsics lens;
  /// Of the intrinsics, in the order of `intrinsics_count`; 0 where they are not estimated. From the
  /// residuals' own scatter, as if each pixel were off independently.
  Eigen::Matrix<double, intrinsics_count, intrinsics_count> covariance;
  double rms = 0;                               ///< Of the distances in its pictures, px.
  double rms_alone = 0;                         ///< The same when it is calibrated without the others, px.
  std::vector<std::optional<double>> view_rms;  ///< By view, held-out ones too; none where it saw no board.
  /// The standard deviation of where the lens shows a direction, px, in the image's corner where it is
  /// largest: boards that do not come near the corners leave it large.
  double corner_sigma = 0;
  /// Which intrinsics these views do not tell: a standard deviation of one (for corners found to a twentieth
  /// of a pixel at best) moves points where they were seen by more than a hundredth of the image's diagonal,
  /// or, where corner_sigma is more than that, the image's corners.
  std::vector<int> untold;

  /// The standard deviation of one, by its place in the order of `intrinsics_count`, in its unit.
  [[nodiscard]] double sigma(int parameter) const;
};

/// Cameras that stand still to each other, calibrated together.
struct IntrinsicsFit {
  bool is_found = false;
  std::string reason;              ///< Why not.
  std::vector<CameraFit> cameras;  ///< In the order of the sizes given.
  std::vector<Pose> poses;         ///< X_1C: each camera in the first one.
  /// Of the small motion [v; w] of X_1C (p + v, exp(w) R); 0 for the first.
  std::vector<Eigen::Matrix<double, 6, 6>> pose_covariance;
  double rms = 0;                      ///< Of the distances in all pictures that were fitted, px.
  double noise = 0;                    ///< Standard deviation of one coordinate of a pixel, px.
  std::size_t points = 0;              ///< Pixels that were fitted.
  std::vector<bool> is_held_out;       ///< By view.
  std::optional<double> held_out_rms;  ///< Of the distances in held-out views, only their boards fitted, px.
  std::vector<std::optional<Pose>> boards;  ///< X_1B by view.
  int steps = 0;                            ///< Of the joint fit.
};

/// Calibrates cameras of the given image sizes (width, height) from views of a board with `points` (z = 0 in
/// B): each alone, by Zhang's closed form (Z. Zhang, 2000) and least squares, and then all together with
/// where they stand. Each camera needs two views at least, that are not parallel; cameras but the first need
/// one together with the first. std::invalid_argument: views with another number of cameras or points, other
/// than 0 to 5 coefficients of distortion.
[[nodiscard]] IntrinsicsFit fit_intrinsics(std::span<const Eigen::Vector2d> points,
                                           std::span<const BoardView> views,
                                           std::span<const std::array<int, 2>> sizes,
                                           const IntrinsicsConfig& config = {});

}  // namespace flexura
