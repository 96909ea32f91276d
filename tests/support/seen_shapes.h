#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "flexura/estimate/shape_estimator.h"
#include "tests/support/mahalanobis.h"
#include "tests/support/seen_arms.h"
#include "tests/support/shape_error.h"

namespace flexura {

/// An arm and its pictures by two cameras at about a right angle.
struct SeenShape {
  BentArm bent;
  std::array<View, 2> views;
  std::array<Image<std::uint8_t>, 2> pictures;
  double noise = 0;  ///< Standard deviation of the picture noise, in values of 8 bits.
};

inline SeenShape random_seen_shape(TestRandom& random) {
  SeenArmConfig options;
  options.noise = random.uniform(0, 4), options.psf = random.uniform(0.5, 1.2);
  RandomArm arm = random_arm(random, options);
  SeenShape result{arm.bent, {}, {}, options.noise};
  const Backbone backbone = arm.bent.backbone();
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < 2; ++i) {
    const double angle =
        turn + static_cast<double>(i) * (0.5 * std::numbers::pi + random.uniform(-0.15, 0.15));
    const Eigen::Vector3d direction(std::cos(angle), random.uniform(-0.2, 0.2), std::sin(angle));
    const Eigen::Vector3d from = middle + direction.normalized() * random.uniform(1.5, 3);
    result.views[i] = pinhole_view(
        look_at(from, middle + random.vector<3>(-0.05, 0.05)), options.width, options.height,
        0.42 * options.height * (from - middle).norm() / (0.55 * backbone.length()) * random.uniform(0.7, 1));
    result.pictures[i] = photograph(arm.scene, result.views[i], options,
                                    static_cast<std::uint64_t>(random.integer(0, 1 << 30)));
  }
  return result;
}

/// Returns shape_error() as a share of the arm's length.
inline double relative_shape_error(const Shape& shape, const Backbone& truth) {
  return shape_error(shape, truth) / truth.length();
}

/// Returns the squared error of the bends, weighted by their estimated covariance. If the covariance is
/// right, it is chi^2 with as many degrees of freedom as bend components.
inline double error_square(const ShapeEstimate& found, const ArmState& truth) {
  const auto count = static_cast<Eigen::Index>(2 * truth.bends.size());
  Eigen::VectorXd off(count);
  for (std::size_t i = 0; i < truth.bends.size(); ++i)
    off.segment<2>(static_cast<Eigen::Index>(2 * i)) = found.shape.state.bends[i] - truth.bends[i];
  return mahalanobis_square(found.covariance.topLeftCorner(count, count), off);
}

/// Returns the probability that the estimated covariance gives to errors smaller than the actual one. It is
/// uniform from 0 to 1 if the covariance is right. Uses E. B. Wilson's and M. M. Hilferty's cube root
/// approximation of chi^2, accurate to 0.01.
inline double expected_share(const ShapeEstimate& found, const ArmState& truth) {
  const auto count = static_cast<double>(2 * truth.bends.size());
  const double spread = 2 / (9 * count);
  const double normal = (std::cbrt(error_square(found, truth) / count) - (1 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(-normal / std::numbers::sqrt2);
}

}  // namespace flexura
