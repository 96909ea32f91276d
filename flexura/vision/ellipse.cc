#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/math/levenberg_marquardt.h"
#include "flexura/math/small_cholesky.h"
#include "flexura/vision/conic.h"

namespace flexura {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;
using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

Eigen::Matrix2d turn(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }

// Returns the eccentric anomaly of the ellipse's point nearest to (x, y), in its own axes. Newton's method on
// the angle between the normal and the connecting line, restricted to the point's quadrant.
double nearest(const Vector2d& axes, const Vector2d& point) {
  const double x = std::abs(point.x()), y = std::abs(point.y());
  const double squared = axes.x() * axes.x() - axes.y() * axes.y();
  double t = std::atan2(axes.x() * y, axes.y() * x), low = 0, high = 0.5 * std::numbers::pi;
  for (int i = 0; i < 60; ++i) {
    const double c = std::cos(t), s = std::sin(t);
    const double slope = axes.x() * x * s - axes.y() * y * c - squared * s * c;
    (slope > 0 ? high : low) = t;
    const double bend = axes.x() * x * c + axes.y() * y * s - squared * (c * c - s * s);
    double next = bend > 0 ? t - slope / bend : 0.5 * (low + high);
    const bool is_between = next > low && next < high;
    if (!is_between) next = 0.5 * (low + high);
    if (std::abs(next - t) < 1e-14) break;
    t = next;
  }
  const double upper = point.y() < 0 ? -t : t;
  return point.x() < 0 ? std::numbers::pi - upper : upper;
}

// Signed distance of a point, and its derivative with respect to centre, semi-axes and angle.
double distance_row(const EllipseFit& ellipse, const Vector2d& point, Vector5* row) {
  const Eigen::Matrix2d R = turn(ellipse.angle);
  const Vector2d local = R.transpose() * (point - ellipse.center);
  const double t = nearest(ellipse.semi_axes, local), c = std::cos(t), s = std::sin(t);
  const Vector2d foot(ellipse.semi_axes.x() * c, ellipse.semi_axes.y() * s);
  const Vector2d normal = Vector2d(ellipse.semi_axes.y() * c, ellipse.semi_axes.x() * s).normalized();
  if (row != nullptr) {
    const Vector2d world = R * normal;
    *row << -world.x(), -world.y(), -normal.x() * c, -normal.y() * s,
        -normal.dot(Vector2d(-foot.y(), foot.x()));
  }
  return (local - foot).dot(normal);
}

// Fits a x^2 + b xy + c y^2 + d x + e y + f = 0 with 4 a c - b^2 = 1 to points about the origin, of size 1.
std::optional<Eigen::Matrix<double, 6, 1>> algebraic(std::span<const Vector2d> points, const Vector2d& mean,
                                                     double size) {
  Matrix3d quadratic = Matrix3d::Zero(), mixed = Matrix3d::Zero(), linear = Matrix3d::Zero();
  for (const Vector2d& point : points) {
    const Vector2d p = (point - mean) / size;
    const Vector3d second(p.x() * p.x(), p.x() * p.y(), p.y() * p.y()), first(p.x(), p.y(), 1);
    quadratic += second * second.transpose(), mixed += second * first.transpose();
    linear += first * first.transpose();
  }
  const Matrix3d to_first = -PivotedCholesky(linear).solve(mixed.transpose());
  const Matrix3d reduced = quadratic + mixed * to_first;
  Matrix3d bound_inverse;
  bound_inverse << 0, 0, 0.5, 0, -1, 0, 0.5, 0, 0;
  const auto [values, vectors] = general_eigen(bound_inverse * reduced);
  for (int i = 0; i < 3; ++i) {
    const Vector3d a = vectors.col(i).real();
    if (std::abs(values[i].imag()) > 1e-12 || 4 * a[0] * a[2] - a[1] * a[1] <= 0) continue;
    Eigen::Matrix<double, 6, 1> result;
    result << a, to_first * a;
    return result;
  }
  return std::nullopt;
}

std::optional<EllipseFit> from_algebraic(const Eigen::Matrix<double, 6, 1>& q, const Vector2d& mean,
                                         double size) {
  Eigen::Matrix2d form;
  form << q[0], 0.5 * q[1], 0.5 * q[1], q[2];
  const Vector2d center = -0.5 * form.inverse() * q.segment<2>(3);
  const double level = -(q[5] + 0.5 * q.segment<2>(3).dot(center));
  const auto [values, vectors] = symmetric_eigen(form);
  const Vector2d squares = level * values.cwiseInverse();
  if (!(squares.minCoeff() > 0) || !center.allFinite()) return std::nullopt;
  EllipseFit fit;
  fit.center = mean + size * center;
  fit.semi_axes = size * squares.cwiseSqrt();
  fit.angle = std::atan2(vectors(1, 0), vectors(0, 0));
  return fit;
}

void put_in_order(EllipseFit& fit) {
  if (fit.semi_axes.x() < fit.semi_axes.y()) {
    std::swap(fit.semi_axes.x(), fit.semi_axes.y());
    fit.angle += 0.5 * std::numbers::pi;
  }
  fit.angle -= std::numbers::pi * std::ceil(fit.angle / std::numbers::pi - 0.5);
}

// An ellipse with its normal equations.
struct Linearized {
  Linearized(const EllipseFit& of, std::span<const Vector2d> points) : fit(of) {
    Vector5 row;
    for (const Vector2d& point : points) {
      const double miss = distance_row(fit, point, &row);
      normal += row * row.transpose(), gradient += miss * row, squares += miss * miss;
    }
  }

  EllipseFit fit;
  Matrix5 normal = Matrix5::Zero();
  Vector5 gradient = Vector5::Zero();
  double squares = 0;
};

// Finds the least-squares ellipse near a start, for points of size 1.
EllipseFit nearest_to(std::span<const Vector2d> points, double size, const EllipseFit& start) {
  Linearized here(start, points), there = here;
  const auto try_step = [&](double damping) -> TriedStep {
    Matrix5 damped = here.normal;
    damped.diagonal() += damping * here.normal.diagonal() + Vector5::Constant(1e-12 * here.normal.trace());
    const Vector5 step = -solve_definite(damped, here.gradient);
    EllipseFit next = here.fit;
    next.center += step.head<2>(), next.semi_axes += step.segment<2>(2), next.angle += step[4];
    if (!step.allFinite() || !(next.semi_axes.minCoeff() > 1e-6 * size)) return {};
    there = Linearized(next, points);
    return {.cost = there.squares};
  };
  const auto keep = [&](const TriedStep&, double& cost) {
    here = there;
    const bool is_last = cost - here.squares < 1e-14 * cost;
    cost = here.squares;
    return is_last;
  };
  const auto leave = [](const TriedStep& step, double cost) { return step.cost <= cost; };
  const auto eased = [](double damping, double) { return std::max(1e-12, damping / 8); };
  levenberg_marquardt(here.squares, {.start = 1e-6, .most = 1e6, .rise = 8, .eased = eased}, 60, try_step,
                      keep, leave);
  return here.fit;
}

}  // namespace

double distance_to(const EllipseFit& ellipse, const Vector2d& point) {
  return distance_row(ellipse, point, nullptr);
}

std::optional<EllipseFit> fit_ellipse(std::span<const Vector2d> points) {
  if (points.size() < 6) return std::nullopt;
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& point : points) mean += point / static_cast<double>(points.size());
  double size = 0;
  for (const Vector2d& point : points) size = std::max(size, (point - mean).norm());
  if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  const auto start = algebraic(points, mean, size);
  auto fit = start ? from_algebraic(*start, mean, size) : std::nullopt;
  if (!fit || fit->semi_axes.maxCoeff() > 1e4 * size) return std::nullopt;
  put_in_order(*fit);
  fit = nearest_to(points, size, *fit);
  put_in_order(*fit);
  // A very thin ellipse counts as a line.
  if (fit->semi_axes.y() < 1e-4 * fit->semi_axes.x()) return std::nullopt;
  Linearized last(*fit, points);
  const auto count = static_cast<double>(points.size());
  fit->rms = std::sqrt(last.squares / count);
  // The angle of a circle is undetermined: a term of the size of rounding keeps the inverse finite.
  last.normal.diagonal().array() += 1e-12 * last.normal.trace();
  fit->covariance = last.squares / std::max(1.0, count - 5) * last.normal.inverse();
  return fit;
}

std::optional<EllipseFit> fit_ellipse_to_most(std::vector<Vector2d>& points, double tolerance) {
  constexpr int tries = 200;
  std::optional<EllipseFit> best;
  std::size_t most = 0;
  std::mt19937 engine(1);
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 300);
  for (int i = 0; i < tries && points.size() >= 6; ++i) {
    std::array<Vector2d, 6> few;
    for (Vector2d& point : few) point = points[engine() % points.size()];
    const auto through = fit_ellipse(few);
    if (!through) continue;
    std::size_t count = 0;
    for (std::size_t j = 0; j < points.size(); j += stride)
      count += std::abs(distance_to(*through, points[j])) < tolerance ? 1 : 0;
    if (count > most) most = count, best = through;
  }
  if (!best) return fit_ellipse(points);
  std::vector<Vector2d> near;
  for (int round = 0; round < 3 && best; ++round) {
    const double bound = round == 0 ? 3 * tolerance : std::max(3.5 * best->rms, 1e-3);
    near.clear();
    std::ranges::copy_if(points, std::back_inserter(near),
                         [&](const Vector2d& point) { return std::abs(distance_to(*best, point)) <= bound; });
    best = fit_ellipse(near);
  }
  if (best) points = std::move(near);
  return best;
}

double share_around(const EllipseFit& ellipse, std::span<const Vector2d> points) {
  // On average two points in each part where all of it is visible.
  const std::size_t parts = std::clamp<std::size_t>(points.size() / 2, 6, 72);
  std::vector<bool> is_seen(parts, false);
  const Eigen::Rotation2Dd back(-ellipse.angle);
  for (const Vector2d& point : points) {
    const Vector2d local = back * (point - ellipse.center);
    const double t = std::atan2(local.y() / ellipse.semi_axes.y(), local.x() / ellipse.semi_axes.x());
    const double turn = 0.5 + t / (2 * std::numbers::pi);
    is_seen[std::min(parts - 1, static_cast<std::size_t>(turn * static_cast<double>(parts)))] = true;
  }
  return static_cast<double>(std::ranges::count(is_seen, true)) / static_cast<double>(parts);
}

}  // namespace flexura
