#include "flexura/study/image_features.h"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

using Point = std::optional<Eigen::Vector2d>;

std::optional<double> distance(const Point& a, const Point& b) {
  if (!a || !b) return std::nullopt;
  return (*a - *b).norm();
}

Point middle(const Point& a, const Point& b) {
  if (!a || !b) return std::nullopt;
  return 0.5 * (*a + *b);
}

// The points relative to their centroid along their principal axes, and their spread there (root mean
// square).
struct Spread {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d size;
  Eigen::Vector2d mean;
};

Spread spread_of(std::span<const Eigen::Vector2d> points) {
  const auto count = static_cast<double>(points.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) scatter += (p - mean) * (p - mean).transpose() / count;
  const Eigen::Matrix2d axes = symmetric_eigen(scatter).vectors;
  Spread spread{{}, Eigen::Vector2d::Zero(), mean};
  for (const Eigen::Vector2d& p : points) {
    spread.points.emplace_back(axes.transpose() * (p - mean));
    spread.size += spread.points.back().cwiseAbs2() / count;
  }
  // Not the roots of the eigenvalues: for a thin ellipse, rounding would remove the smaller one.
  spread.size = spread.size.cwiseSqrt();
  return spread;
}

}  // namespace

std::optional<double> axes_ratio(std::span<const Eigen::Vector2d> points) {
  if (points.size() < 5) return std::nullopt;
  const Spread spread = spread_of(points);
  // All at one place up to rounding.
  if (!(spread.size.y() > 1e-14 * spread.mean.norm())) return std::nullopt;
  if (spread.size.x() <= 1e-12 * spread.size.y()) return 0.0;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Eigen::Vector2d& p : spread.points) {
    const Eigen::Vector2d q = p.cwiseQuotient(spread.size);
    const Eigen::Vector<double, 6> terms{q.x() * q.x(), q.x() * q.y(), q.y() * q.y(), q.x(), q.y(), 1};
    normal += terms * terms.transpose();
  }
  const Eigen::Vector<double, 6> conic = symmetric_eigen(normal).vectors.col(0);
  // The quadratic part a x^2 + b xy + c y^2, in px again.
  const double a = conic[0] / (spread.size.x() * spread.size.x());
  const double b = conic[1] / (spread.size.x() * spread.size.y());
  const double c = conic[2] / (spread.size.y() * spread.size.y());
  const double determinant = a * c - 0.25 * b * b;
  if (!(determinant > 0)) return std::nullopt;
  const double larger = 0.5 * (std::abs(a + c) + std::hypot(a - c, b));
  return std::sqrt(determinant) / larger;
}

ImageFeatures features_of(const TargetImage& image) {
  const auto& at = image.circle;
  ImageFeatures features;
  features[0] = distance(at[top_left], at[top_right]);
  features[1] = distance(at[bottom_left], at[bottom_right]);
  features[2] = distance(at[top_left], at[bottom_left]);
  features[3] = distance(at[top_right], at[bottom_right]);
  features[4] = distance(middle(at[top_left], at[top_right]), middle(at[bottom_left], at[bottom_right]));
  features[5] = distance(middle(at[top_left], at[bottom_left]), middle(at[top_right], at[bottom_right]));
  features[6] = distance(at[top_right], image.center);
  features[7] = distance(at[circle_top], image.center);
  std::vector<Eigen::Vector2d> points;
  for (const Point& point : at)
    if (point) points.push_back(*point);
  if (points.size() == at.size()) features[8] = axes_ratio(points);
  return features;
}

}  // namespace flexura
