#include "flexura/board/board_certainty.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "flexura/math/dense.h"

namespace flexura {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

Eigen::Vector<double, intrinsics_count> intrinsics_effects(const Intrinsics& lens,
                                                           std::span<const Vector2d> pixels) {
  double a = 1e-6, b = 1e-6, q = 1e-12;
  for (const Vector2d& pixel : pixels) {
    const double x = std::abs(pixel.x() - lens.cx) / lens.fx, y = std::abs(pixel.y() - lens.cy) / lens.fy;
    a = std::max(a, x), b = std::max(b, y), q = std::max(q, x * x + y * y);
  }
  const double f = std::max(lens.fx, lens.fy), r = std::sqrt(q);
  Eigen::Vector<double, intrinsics_count> result;
  result.setOnes();
  result.head<2>() << a, b;
  const double first = f * r * q, second = first * q, third = second * q;
  auto by_distortion = result.tail<static_cast<int>(Distortion::most)>();
  if (lens.distortion.model() == LensModel::fisheye) {
    by_distortion.head<4>() << first, second, third, third * q;
  } else {
    by_distortion.head<5>() << first, second, 3 * f * q, 3 * f * q, third;
    if (lens.distortion.model() == LensModel::rational) by_distortion.tail<3>() << first, second, third;
  }
  return result;
}

std::array<Vector2d, 4> image_corners(int width, int height) {
  const double right = width - 1, bottom = height - 1;
  return {Vector2d(0, 0), Vector2d(right, 0), Vector2d(0, bottom), Vector2d(right, bottom)};
}

double corner_sigma(const Intrinsics& lens,
                    const Eigen::Matrix<double, intrinsics_count, intrinsics_count>& covariance, int width,
                    int height) {
  const Lens whole(lens);
  double largest = 0;
  for (const Vector2d& corner : image_corners(width, height)) {
    const auto direction = whole.unproject(corner);
    const auto there = direction ? whole.project_with_derivatives(direction->homogeneous()) : std::nullopt;
    if (!there) return std::numeric_limits<double>::infinity();
    largest =
        std::max(largest, (there->by_intrinsics * covariance * there->by_intrinsics.transpose()).trace());
  }
  return std::sqrt(largest);
}

MatrixXd covariance_of(const MatrixXd& information, const VectorXd& scale) {
  // In units in which each unknown moves a corner by a pixel, so that the smallest eigenvalues belong to
  // undetermined directions.
  const MatrixXd scaled = scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal();
  const auto [values, vectors] = symmetric_eigen(scaled);
  const double least = 1e-12 * std::max(values.maxCoeff(), 1e-300);
  const VectorXd inverse = values.cwiseMax(least).cwiseInverse();
  const MatrixXd directions = scale.cwiseInverse().asDiagonal() * vectors;
  return directions * inverse.asDiagonal() * directions.transpose();
}

}  // namespace flexura
