#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Returns the homography H from a board's plane to an image: pixel ~ H (x, y, 1), of Frobenius norm 1. Uses
/// the direct linear transformation of normalised points (R. Hartley, "In defence of the eight-point
/// algorithm", 1997). Needs at least four points and as many pixels; empty if they are collinear.
[[nodiscard]] std::optional<Eigen::Matrix3d> board_homography(std::span<const Eigen::Vector2d> points,
                                                              std::span<const Eigen::Vector2d> pixels);

/// Returns an initial lens without distortion from homographies of boards, by Z. Zhang, "A flexible new
/// technique for camera calibration" (2000), section 3.1. The principal point is that of the homographies if
/// it is inside the image, otherwise the image's middle. Always returns a lens: if nothing is determined, one
/// with a 50 degree field of view.
[[nodiscard]] Intrinsics start_lens(std::span<const Eigen::Matrix3d> homographies, int width, int height);

/// Returns the approximate X_CB of the board whose points (z = 0 in B) have these pixels; empty if the lens
/// does not show some of them.
[[nodiscard]] std::optional<Pose> start_pose(const Lens& lens, std::span<const Eigen::Vector2d> points,
                                             std::span<const Eigen::Vector2d> pixels);

}  // namespace flexura
