#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Returns the homography H from a board's plane to an image: pixel ~ H (x, y, 1). H has Frobenius norm 1.
/// Uses the direct linear transformation with normalized points (R. Hartley, "In defence of the eight-point
/// algorithm", 1997). Needs equally many pixels. Pixels that are NaN are not used. Empty for fewer than four
/// others, and if their points are collinear.
[[nodiscard]] std::optional<Eigen::Matrix3d> board_homography(std::span<const Eigen::Vector2d> points,
                                                              std::span<const Eigen::Vector2d> pixels);

/// Returns an initial lens without distortion from homographies of boards, by Z. Zhang, "A flexible new
/// technique for camera calibration" (2000), section 3.1. If the principal point from the homographies is
/// outside the image, the image's middle is used instead. If the homographies do not determine a lens, the
/// result has a field of view of 50 degrees.
[[nodiscard]] Intrinsics start_lens(std::span<const Eigen::Matrix3d> homographies, int width, int height);

/// Returns the approximate pose X_CB of a board whose `points` (z = 0 in B) have the given pixels. Empty if
/// the lens has no ray for some of the pixels.
[[nodiscard]] std::optional<Pose> start_pose(const Lens& lens, std::span<const Eigen::Vector2d> points,
                                             std::span<const Eigen::Vector2d> pixels);

}  // namespace flexura
