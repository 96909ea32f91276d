#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// The homography H from a board's plane to an image: pixel ~ H (x, y, 1), of Frobenius norm 1, by the direct
/// linear transformation of normalized points (R. Hartley, "In defence of the eight-point algorithm", 1997).
/// At least four points, as many as pixels; none when they lie on a line.
[[nodiscard]] std::optional<Eigen::Matrix3d> board_homography(std::span<const Eigen::Vector2d> points,
                                                              std::span<const Eigen::Vector2d> pixels);

/// A lens without distortion to begin with, from homographies of boards, by Z. Zhang, "A flexible new
/// technique for camera calibration" (2000), section 3.1: with the principal point where the homographies put
/// it when they tell it inside the image, and else in its middle. Always one: where nothing is told, of 50
/// degrees across.
[[nodiscard]] Intrinsics start_lens(std::span<const Eigen::Matrix3d> homographies, int width, int height);

/// X_CB of the board whose points (z = 0 in B) have these pixels, roughly; none when the lens shows some of
/// them nowhere.
[[nodiscard]] std::optional<Pose> start_pose(const Lens& lens, std::span<const Eigen::Vector2d> points,
                                             std::span<const Eigen::Vector2d> pixels);

}  // namespace flexura
