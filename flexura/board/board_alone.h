#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/board/board_bundle.h"
#include "flexura/math/pose.h"

namespace flexura {

/// A camera calibrated alone.
struct CameraAlone {
  BundleFit fit;                   ///< Fit of this camera and the boards that it saw.
  std::vector<std::size_t> views;  ///< Indices of these boards in the given views.
};

/// Returns the root mean square of `points` distances.
[[nodiscard]] double rms_of(double square_sum, std::size_t points);

/// Calibrates one camera of the given image size (width, height) from the views in which it saw the board.
/// Uses the closed form and least squares; after a bad result, also other initial focal lengths. Not
/// converged with fewer than two views.
[[nodiscard]] CameraAlone fit_alone(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                                    std::size_t camera, const std::array<int, 2>& size,
                                    const BundleConfig& config);

/// Pose of a camera in the first one, from one view in which both saw the board.
struct CameraStep {
  std::size_t view = 0;  ///< Index in the given views.
  Pose X_1C;
};
[[nodiscard]] std::vector<CameraStep> camera_steps(const CameraAlone& first, const CameraAlone& other);

/// Returns X_1C, the mean over the views; empty without a view.
[[nodiscard]] std::optional<Pose> start_camera(std::span<const CameraStep> steps);

/// Disagreement of the views about a camera's pose.
struct StepSpread {
  double turn = 0, distance = 0;  ///< Largest deviation of a view from the majority, rad and m.
  std::size_t view = 0;           ///< Index of that view in the given ones.
};
/// Computes the deviations from the step that is nearest to the others (smallest median of its rotations from
/// them). Needs at least one step.
[[nodiscard]] StepSpread step_spread(std::span<const CameraStep> steps);

}  // namespace flexura
