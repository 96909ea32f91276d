#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "flexura/camera/intrinsics.h"

namespace flexura {

/// Returns, for each intrinsic, about how many pixels a unit of it moves the most affected of these pixels
/// (at least one). In the order of `intrinsics_count`; all above 0.
[[nodiscard]] Eigen::Vector<double, intrinsics_count> intrinsics_effects(
    const Intrinsics& lens, std::span<const Eigen::Vector2d> pixels);

/// Returns the standard deviation, px, of the image position of a direction seen in a corner of the image.
/// The image has width x height px; the worst corner counts. Infinite if the lens has no direction for a
/// corner.
[[nodiscard]] double corner_sigma(const Intrinsics& lens,
                                  const Eigen::Matrix<double, intrinsics_count, intrinsics_count>& covariance,
                                  int width, int height);

/// Returns the corners of an image.
[[nodiscard]] std::array<Eigen::Vector2d, 4> image_corners(int width, int height);

/// Returns the inverse of BundleFit::information, for unknowns of which a unit moves pixels by about `scale`
/// px. Undetermined directions get a huge finite variance.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale);

}  // namespace flexura
