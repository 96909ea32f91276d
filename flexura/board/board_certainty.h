#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "flexura/camera/intrinsics.h"

namespace flexura {

/// By how many pixels a unit of each intrinsic moves the one of these pixels (at least one) that it moves
/// most, roughly. In the order of `intrinsics_count`; all above 0.
[[nodiscard]] Eigen::Vector<double, intrinsics_count> intrinsics_effects(
    const Intrinsics& lens, std::span<const Eigen::Vector2d> pixels);

/// The standard deviation, px, of where the direction is seen that is in a corner of the image (of width x
/// height px), in the corner where it is largest; infinite where the lens shows no direction in a corner.
[[nodiscard]] double corner_sigma(const Intrinsics& lens,
                                  const Eigen::Matrix<double, intrinsics_count, intrinsics_count>& covariance,
                                  int width, int height);

/// The corners of an image.
[[nodiscard]] std::array<Eigen::Vector2d, 4> image_corners(int width, int height);

/// The inverse of BundleFit::information, for unknowns of which a unit moves pixels by about `scale` px.
/// Directions that the views do not tell get a huge variance instead of none.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale);

}  // namespace flexura
