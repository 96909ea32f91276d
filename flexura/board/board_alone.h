#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/board/board_bundle.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Result of calibrating one camera alone.
struct CameraAlone {
  BundleFit fit;  ///< Fit of the camera and of the boards that the camera saw.
  std::vector<std::size_t>
      views;  ///< Indices, in the given views, of the views in which the camera saw the board.
};

/// Returns the root mean square of `points` distances from the sum of their squares.
[[nodiscard]] double rms_of(double square_sum, std::size_t points);

/// Calibrates one camera from the views in which the camera saw the board. `size` is the image's width and
/// height, px. Uses Zhang's closed form and least squares. If the result is bad, or the lens is a fisheye
/// lens, tries other initial focal lengths. With fewer than two views, the result is not converged.
[[nodiscard]] CameraAlone fit_alone(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                                    std::size_t camera, const std::array<int, 2>& size, LensModel model,
                                    const BundleConfig& config);

/// Pose of a camera relative to the first camera, from one view in which both cameras saw the board.
struct CameraStep {
  std::size_t view = 0;  ///< Index of the view in the given views.
  Pose X_1C;
};

/// Returns the mean pose X_1C over the views; empty if there are no views.
[[nodiscard]] std::optional<Pose> start_camera(std::span<const CameraStep> steps);

/// Disagreement of views about a camera's pose relative to the first camera.
struct StepSpread {
  /// Rotation (rad) and distance (m) between the most deviating view and the majority.
  double turn = 0, distance = 0;
  std::size_t view = 0;  ///< Index of the most deviating view in the given views.
};
/// Computes deviations from the central step: the one with the smallest median rotation to the other steps.
/// Requires at least one step.
[[nodiscard]] StepSpread step_spread(std::span<const CameraStep> steps);

}  // namespace flexura
