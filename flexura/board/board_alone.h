#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/board/board_bundle.h"
#include "flexura/math/pose.h"

namespace flexura {

/// One camera calibrated by itself.
struct CameraAlone {
  BundleFit fit;                   ///< Of this camera and the boards that it saw.
  std::vector<std::size_t> views;  ///< Which these are, of the views given.
};

/// The root mean square of so many distances.
[[nodiscard]] double rms_of(double square_sum, std::size_t points);

/// Calibrates one camera of the given image size (width, height) from the views in which it saw the board: by
/// the closed form and least squares, from other focal lengths too where that ends badly. Not converged with
/// fewer than two views.
[[nodiscard]] CameraAlone fit_alone(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                                    std::size_t camera, const std::array<int, 2>& size,
                                    const BundleConfig& config);

/// Where one view, in which both cameras saw the board, has a camera in the first one.
struct CameraStep {
  std::size_t view = 0;  ///< Of the views given.
  Pose X_1C;
};
[[nodiscard]] std::vector<CameraStep> camera_steps(const CameraAlone& first, const CameraAlone& other);

/// X_1C, the mean of what the views say; none without a view.
[[nodiscard]] std::optional<Pose> start_camera(std::span<const CameraStep> steps);

/// How far the views disagree about where a camera is.
struct StepSpread {
  double turn = 0, distance = 0;  ///< rad and m, of the view that is farthest
  std::size_t view = 0;           ///< from what most say, and which of the views given that is.
};
/// From the step that is nearest to the others (the median of its turns from them is least). At least one
/// step.
[[nodiscard]] StepSpread step_spread(std::span<const CameraStep> steps);

}  // namespace flexura
