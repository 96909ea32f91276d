#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "flexura/camera/intrinsics.h"

namespace flexura {

/// Returns, for each intrinsic parameter, the approximate motion of the most affected pixel in `pixels`, px
/// per unit of the parameter. Parameters are in the order of `intrinsics_count`. All results are above 0.
/// Needs at least one pixel.
[[nodiscard]] Eigen::Vector<double, intrinsics_count> intrinsics_effects(
    const Intrinsics& lens, std::span<const Eigen::Vector2d> pixels);

/// Returns the standard deviation, px, of the image position of a direction that is visible in a corner of
/// the image, for the worst corner. The image has width x height px. The result is infinite if the lens has
/// no ray for a corner.
[[nodiscard]] double corner_sigma(const Intrinsics& lens,
                                  const Eigen::Matrix<double, intrinsics_count, intrinsics_count>& covariance,
                                  int width, int height);

/// Returns the pixels (u, v) of the corners of an image of width x height px.
[[nodiscard]] std::array<Eigen::Vector2d, 4> image_corners(int width, int height);

/// Returns the inverse of BundleFit::information. `scale` has the approximate motion of pixels, px, per unit
/// of each unknown. Undetermined combinations of unknowns have a huge finite variance.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale);

}  // namespace flexura
