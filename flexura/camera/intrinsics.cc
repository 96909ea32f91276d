#include "flexura/camera/intrinsics.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

// Returns the smallest positive root of the derivative 1 + 3 k1 q + 5 k2 q^2 + 7 k3 q^3 of the radial part,
// where q = r^2. Infinite if there is no such root. The cubic is monotone between its turning points, so
// bisection finds the first change of sign.
double largest_radius_of(const std::array<double, 5>& distortion) {
  const double c1 = 3 * distortion[0], c2 = 5 * distortion[1], c3 = 7 * distortion[4];
  const auto slope = [&](double q) { return 1 + q * (c1 + q * (c2 + q * c3)); };
  std::array<double, 3> ends = {infinity, infinity, infinity};  // Ends of the monotone pieces.
  int count = 0;
  const auto add_turn = [&](double q) {
    if (std::isfinite(q) && q > 0) ends[static_cast<std::size_t>(count++)] = q;
  };
  const double discriminant = c2 * c2 - 3 * c3 * c1;
  if (c3 != 0 && discriminant >= 0) {
    // Roots of c1 + 2 c2 q + 3 c3 q^2 = 0, computed without cancellation.
    const double larger = -(c2 + std::copysign(std::sqrt(discriminant), c2));
    add_turn(larger / (3 * c3));
    if (larger != 0) add_turn(c1 / larger);
  } else if (c3 == 0 && c2 != 0) {
    add_turn(-c1 / (2 * c2));
  }
  std::sort(ends.begin(), ends.begin() + count);
  double low = 0;
  for (std::size_t piece = 0; piece < 3; ++piece) {
    double high = ends[piece];
    if (high == infinity) {
      // The last piece: its end is doubled until the sign changes, or until 89.99 degrees from the axis,
      // which is beyond any lens.
      constexpr double beyond = 1e8;
      for (high = std::max(1.0, 2 * low); high < beyond && slope(high) > 0;) high *= 2;
      if (slope(high) > 0) return infinity;
    }
    if (slope(high) > 0) {
      low = high;
      continue;
    }
    for (int step = 0; step < 200 && low < high; ++step) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (slope(middle) > 0 ? low : high) = middle;
    }
    return std::sqrt(low);
  }
  return infinity;
}

// Returns the point that radial distortion maps to `desired`; if there is no such point, a point near the
// rim.
Eigen::Vector2d undistort_radially(const Eigen::Vector2d& desired, const std::array<double, 5>& distortion,
                                   double largest_radius) {
  const double radius = desired.norm();
  if (!(radius > 0)) return desired;
  const double k1 = distortion[0], k2 = distortion[1], k3 = distortion[4];
  constexpr double beyond = 1e4;
  double low = 0, high = std::min(largest_radius, beyond);
  double r = std::min(radius, high);
  for (int step = 0; step < 100 && high - low > 1e-15 * high; ++step) {
    const double q = r * r;
    const double excess = r * (1 + q * (k1 + q * (k2 + q * k3))) - radius;
    const double slope = 1 + q * (3 * k1 + q * (5 * k2 + q * 7 * k3));
    (excess > 0 ? high : low) = r;
    const double next = r - excess / slope;
    // Newton's step if the result is in the bracket, otherwise bisection.
    const double middle = 0.5 * (low + high);
    const double last = r;
    r = next > low && next < high ? next : middle;
    if (std::abs(r - last) <= 1e-15 * r) break;
  }
  return desired * (r / radius);
}

// Distorted coordinates, and their derivative with respect to the undistorted coordinates.
struct Distorted {
  Eigen::Vector2d point;
  Eigen::Matrix2d by_point;
};

Distorted distort(const Eigen::Vector2d& normal, const std::array<double, 5>& distortion) {
  const auto [k1, k2, p1, p2, k3] = distortion;
  const double a = normal.x(), b = normal.y(), q = a * a + b * b;
  const double radial = 1 + q * (k1 + q * (k2 + q * k3));
  // Twice the derivative of the radial factor with respect to q.
  const double slope = 2 * (k1 + q * (2 * k2 + q * 3 * k3));
  Distorted result;
  result.point = {a * radial + 2 * p1 * a * b + p2 * (q + 2 * a * a),
                  b * radial + p1 * (q + 2 * b * b) + 2 * p2 * a * b};
  const double mixed = a * b * slope + 2 * p1 * a + 2 * p2 * b;
  result.by_point << radial + a * a * slope + 2 * p1 * b + 6 * p2 * a, mixed, mixed,
      radial + b * b * slope + 6 * p1 * b + 2 * p2 * a;
  return result;
}

}  // namespace

Lens::Lens(const Intrinsics& intrinsics)
    : intrinsics_(intrinsics), largest_radius_(largest_radius_of(intrinsics.distortion)) {
  for (const double focal_length : {intrinsics.fx, intrinsics.fy})
    require(std::isfinite(focal_length) && focal_length > 0, "a focal length must be a positive number");
  require(std::isfinite(intrinsics.cx) && std::isfinite(intrinsics.cy),
          "the principal point must be two finite numbers");
  for (const double coefficient : intrinsics.distortion)
    require(std::isfinite(coefficient), "the distortion must be five finite numbers");
}

std::optional<Eigen::Vector2d> Lens::project(const Eigen::Vector3d& p_CP) const {
  if (!(p_CP.z() > 0)) return std::nullopt;
  Eigen::Vector2d point = p_CP.head<2>() / p_CP.z();
  if (!point.allFinite()) return std::nullopt;
  if (intrinsics_.is_distorted()) {
    if (point.norm() > largest_radius_) return std::nullopt;
    point = distort(point, intrinsics_.distortion).point;
  }
  Eigen::Vector2d pixel(intrinsics_.fx * point.x() + intrinsics_.cx,
                        intrinsics_.fy * point.y() + intrinsics_.cy);
  if (!pixel.allFinite()) return std::nullopt;
  return pixel;
}

std::optional<Projection> Lens::project_with_derivatives(const Eigen::Vector3d& p_CP) const {
  const auto pixel = project(p_CP);
  if (!pixel) return std::nullopt;
  const Eigen::Vector2d normal = p_CP.head<2>() / p_CP.z();
  const Distorted distorted = distort(normal, intrinsics_.distortion);
  const double fx = intrinsics_.fx, fy = intrinsics_.fy, a = normal.x(), b = normal.y(),
               q = normal.squaredNorm();
  Projection result;
  result.pixel = *pixel;
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << 1, 0, -a, 0, 1, -b;
  result.by_point = Eigen::Vector2d(fx, fy).asDiagonal() * distorted.by_point * by_point / p_CP.z();
  result.by_intrinsics << distorted.point.x(), 0, 1, 0, fx * a * q, fx * a * q * q, 2 * fx * a * b,
      fx * (q + 2 * a * a), fx * a * q * q * q,  //
      0, distorted.point.y(), 0, 1, fy * b * q, fy * b * q * q, fy * (q + 2 * b * b), 2 * fy * a * b,
      fy * b * q * q * q;
  return result;
}

// Computes each component separately, because writing a matrix in parts and reading it as a whole would stall
// the processor.
bool Lens::project_by_point(const Eigen::Vector3d& p_CP, PointProjection& result) const {
  const double z = p_CP.z();
  if (!(z > 0)) return false;
  const double fx = intrinsics_.fx, fy = intrinsics_.fy, over = 1 / z, a = p_CP.x() / z, b = p_CP.y() / z;
  double u = a, v = b, u_a = 1, mixed = 0, v_b = 1;
  if (intrinsics_.is_distorted()) {
    const auto [k1, k2, p1, p2, k3] = intrinsics_.distortion;
    const double q = a * a + b * b;
    if (!(q <= largest_radius_ * largest_radius_)) return false;
    const double radial = 1 + q * (k1 + q * (k2 + q * k3)), slope = 2 * (k1 + q * (2 * k2 + q * 3 * k3));
    u = a * radial + 2 * p1 * a * b + p2 * (q + 2 * a * a);
    v = b * radial + p1 * (q + 2 * b * b) + 2 * p2 * a * b;
    mixed = a * b * slope + 2 * p1 * a + 2 * p2 * b;
    u_a = radial + a * a * slope + 2 * p1 * b + 6 * p2 * a;
    v_b = radial + b * b * slope + 6 * p1 * b + 2 * p2 * a;
  }
  const double x = fx * over, y = fy * over;
  result.pixel = {fx * u + intrinsics_.cx, fy * v + intrinsics_.cy};
  result.by_point.col(0) = Eigen::Vector2d(x * u_a, y * mixed);
  result.by_point.col(1) = Eigen::Vector2d(x * mixed, y * v_b);
  result.by_point.col(2) = Eigen::Vector2d(-x * (u_a * a + mixed * b), -y * (mixed * a + v_b * b));
  return std::isfinite(result.pixel.x() + result.pixel.y());
}

std::optional<Eigen::Vector2d> Lens::unproject(const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d desired((pixel.x() - intrinsics_.cx) / intrinsics_.fx,
                          (pixel.y() - intrinsics_.cy) / intrinsics_.fy);
  if (!desired.allFinite()) return std::nullopt;
  if (!intrinsics_.is_distorted()) return desired;
  // Starts from the radial part alone, whose inversion always succeeds. Then Newton's method, damped so that
  // the error falls; steps outside the field are pulled back into it.
  constexpr int most_steps = 60;
  constexpr double tolerance = 1e-15;
  const auto inside = [this](const Eigen::Vector2d& normal) {
    const double radius = normal.norm();
    return radius > largest_radius_ ? Eigen::Vector2d(normal * (largest_radius_ / radius)) : normal;
  };
  Eigen::Vector2d normal = inside(undistort_radially(desired, intrinsics_.distortion, largest_radius_));
  Distorted distorted = distort(normal, intrinsics_.distortion);
  double error = (distorted.point - desired).norm();
  const double close = tolerance * (1 + desired.norm());
  for (int step = 0; step < most_steps && error > close; ++step) {
    const Eigen::Vector2d move = distorted.by_point.inverse() * (desired - distorted.point);
    bool fell = false;
    for (double part = 1; part > 1e-4 && !fell; part /= 2) {
      const Eigen::Vector2d tried = inside(normal + part * move);
      const Distorted there = distort(tried, intrinsics_.distortion);
      const double new_error = (there.point - desired).norm();
      if (!(new_error < error)) continue;
      normal = tried, distorted = there, error = new_error;
      fell = true;
    }
    if (!fell) break;
  }
  // At the rim, rounding errors can prevent convergence beyond this tolerance.
  if (!(error <= 1e-12 * (1 + desired.norm()))) return std::nullopt;
  return normal;
}

}  // namespace flexura
