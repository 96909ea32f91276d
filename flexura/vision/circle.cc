#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/math/small_cholesky.h"
#include "flexura/vision/conic.h"

namespace flexura {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;
using std::numbers::pi;

// Chi-square with two degrees of freedom: the bound exceeded in 1 of 100 cases, and the noncentrality for
// which it is exceeded in 9 of 10.
constexpr double chi_square_bound = 9.21, noncentrality = 17.43;

// Points relative to their mean, scaled to size 1.
struct Normalized {
  Vector2d mean = Vector2d::Zero();
  double size = 0;
};

Normalized normalized(std::span<const Vector2d> points) {
  Normalized result;
  for (const Vector2d& point : points) result.mean += point / static_cast<double>(points.size());
  for (const Vector2d& point : points) result.size = std::max(result.size, (point - result.mean).norm());
  return result;
}

// Fits A z + B x + C y + D = 0 with z = x^2 + y^2: minimises the square sum under B^2 + C^2 - 4 A D = 1. This
// is the generalised eigenvector of the smallest nonnegative eigenvalue.
std::optional<Vector3d> pratt(std::span<const Vector2d> points, const Normalized& unit) {
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  for (const Vector2d& point : points) {
    const Vector2d p = (point - unit.mean) / unit.size;
    const Eigen::Vector4d row(p.squaredNorm(), p.x(), p.y(), 1);
    moments += row * row.transpose();
  }
  Eigen::Matrix4d inverse_bound = Eigen::Matrix4d::Zero();
  inverse_bound(0, 3) = inverse_bound(3, 0) = -0.5;
  inverse_bound(1, 1) = inverse_bound(2, 2) = 1;
  const auto [values, vectors] = general_eigen(inverse_bound * moments);
  double least = 1e300;
  std::optional<Eigen::Vector4d> best;
  for (int i = 0; i < 4; ++i) {
    const double value = values[i].real();
    if (std::abs(values[i].imag()) > 1e-9 || value < -1e-9 || value >= least) continue;
    least = value, best = vectors.col(i).real();
  }
  if (!best || std::abs((*best)[0]) < 1e-9 * best->norm()) return std::nullopt;
  const Vector2d center = -best->segment<2>(1) / (2 * (*best)[0]);
  const double squared = center.squaredNorm() - (*best)[3] / (*best)[0];
  if (!(squared > 0)) return std::nullopt;
  return Vector3d(center.x(), center.y(), std::sqrt(squared));
}

// Evaluates the points in the order of their directions from the centre. The largest gap is the part of the
// circle without points. Also computes the correlation of neighbours' residuals, except across the gap.
void go_around(std::span<const Vector2d> points, CircleFit& fit) {
  std::vector<std::pair<double, double>> misfits;  // By angle.
  misfits.reserve(points.size());
  double squares = 0, products = 0;
  for (const Vector2d& point : points) {
    const Vector2d way = point - fit.center;
    misfits.emplace_back(std::atan2(way.y(), way.x()), way.norm() - fit.radius);
    squares += misfits.back().second * misfits.back().second;
  }
  std::ranges::sort(misfits);
  double gap = misfits.front().first + 2 * pi - misfits.back().first;
  for (std::size_t i = 1; i < misfits.size(); ++i) {
    gap = std::max(gap, misfits[i].first - misfits[i - 1].first);
    products += misfits[i - 1].second * misfits[i].second;
  }
  // A gap of about the spacing of the points is not a gap.
  fit.arc = gap < 3 * 2 * pi / static_cast<double>(misfits.size()) ? 2 * pi : 2 * pi - gap;
  fit.misfit_correlation = squares > 0 ? products / squares : 0;
}

// A circle tilted by tau appears as radius (1 - tau^2/4 + tau^2/4 cos 2 (phi - phi0)). The test uses the part
// of the second harmonic that is orthogonal to the circle's own unknowns.
void test_circle(std::span<const Vector2d> points, double sigma, CircleFit& fit) {
  Matrix3d own = Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> mixed = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d harmonic = Eigen::Matrix2d::Zero();
  Vector3d own_left = Vector3d::Zero();
  Vector2d left = Vector2d::Zero();
  for (const Vector2d& point : points) {
    const Vector2d way = point - fit.center;
    const double phi = std::atan2(way.y(), way.x()), distance = way.norm() - fit.radius;
    const Vector3d unknowns(std::cos(phi), std::sin(phi), 1);
    const Vector2d second(std::cos(2 * phi), std::sin(2 * phi));
    own += unknowns * unknowns.transpose(), mixed += unknowns * second.transpose();
    harmonic += second * second.transpose();
    own_left += distance * unknowns, left += distance * second;
  }
  const PivotedCholesky solver(own);
  const Eigen::Matrix2d gram = harmonic - mixed.transpose() * solver.solve(mixed);
  const Vector2d gradient = left - mixed.transpose() * solver.solve(own_left);
  const auto [values, vectors] = symmetric_eigen(gram);
  const double least = std::max(0.0, values[0]);
  double statistic = 0;
  for (int i = 0; i < 2; ++i) {
    if (values[i] < 1e-12 * static_cast<double>(points.size())) continue;
    statistic += std::pow(vectors.col(i).dot(gradient), 2) / values[i];
  }
  fit.is_verified = statistic <= chi_square_bound * sigma * sigma;
  const double amplitude = least > 0 ? sigma * std::sqrt(noncentrality / least) : fit.radius;
  const double tilt = 2 * std::sqrt(amplitude / fit.radius);
  fit.detectable_tilt = tilt < 0.5 * pi ? tilt : 0.5 * pi;
}

// Information that the points give about a circle's center and radius, to first order. It depends on the
// directions of the points from the center. On a flat arc the directions are almost equal, so that they are
// taken relative to their mean. This makes the center (`spread`, `gradient`) and the radius in the mean
// direction (`miss`) independent.
struct Facing {
  Vector2d mean = Vector2d::Zero();                  // Mean direction.
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();  // Sum of squares of the directions about the mean.
  // Gradient of the points' distances from the circle, relative to the mean direction.
  Vector2d gradient = Vector2d::Zero();
  double miss = 0, squares = 0;  // Sum of the distances from the circle, px, and of their squares.
};

Facing facing_of(std::span<const Vector2d> points, const CircleFit& circle) {
  const auto direction = [&](const Vector2d& way, double distance) {
    return distance > 0 ? Vector2d(way / distance) : Vector2d(1, 0);
  };
  Facing facing;
  for (const Vector2d& point : points) {
    const Vector2d way = point - circle.center;
    facing.mean += direction(way, way.norm()) / static_cast<double>(points.size());
  }
  for (const Vector2d& point : points) {
    const Vector2d way = point - circle.center;
    const double distance = way.norm(), miss = distance - circle.radius;
    const Vector2d off = direction(way, distance) - facing.mean;
    facing.spread += off * off.transpose(), facing.gradient += miss * off;
    facing.miss += miss, facing.squares += miss * miss;
  }
  return facing;
}

// Covariance of center and radius for points with a standard deviation of 1 px.
Matrix3d covariance_of(const Facing& facing, double count) {
  Matrix3d apart = Matrix3d::Zero(), to_radius = Matrix3d::Identity();
  apart.col(0).head<2>() = solve_definite<2>(facing.spread, Vector2d::UnitX());
  apart.col(1).head<2>() = solve_definite<2>(facing.spread, Vector2d::UnitY());
  apart(2, 2) = 1 / count;
  to_radius.row(2).head<2>() = -facing.mean.transpose();
  return to_radius * apart * to_radius.transpose();
}

}  // namespace

std::optional<CircleFit> fit_circle(std::span<const Vector2d> points, std::optional<double> sigma) {
  if (points.size() < 3) return std::nullopt;
  const Normalized unit = normalized(points);
  if (!(unit.size > 0) || !std::isfinite(unit.size)) return std::nullopt;
  const auto start = pratt(points, unit);
  if (!start || start->tail<1>()[0] > 1e4) return std::nullopt;
  CircleFit fit;
  fit.center = unit.mean + unit.size * start->head<2>(), fit.radius = unit.size * (*start)[2];
  const auto count = static_cast<double>(points.size());
  Facing facing;
  for (int round = 0; round < 50; ++round) {
    facing = facing_of(points, fit);
    const Vector2d step = solve_definite(facing.spread, facing.gradient);
    const double growth = facing.miss / count - facing.mean.dot(step);
    if (!step.allFinite() || !std::isfinite(growth)) return std::nullopt;
    fit.center += step, fit.radius += growth;
    if (std::hypot(step.norm(), growth) < 1e-10 * unit.size) break;
  }
  if (!(fit.radius > 0) || !fit.center.allFinite()) return std::nullopt;
  const double squares = facing.squares;
  fit.rms = std::sqrt(squares / count);
  const double spread = sigma.value_or(count > 3 ? std::sqrt(squares / (count - 3)) : 0);
  fit.sigma = sigma.value_or(0);
  fit.covariance = spread * spread * covariance_of(facing, count);
  go_around(points, fit);
  // Five points or fewer always lie on an ellipse.
  constexpr std::size_t decided = 6;
  fit.detectable_tilt = 0.5 * pi;
  if (points.size() >= decided) test_circle(points, std::max(spread, 1e-9 * fit.radius), fit);
  return fit;
}

}  // namespace flexura
