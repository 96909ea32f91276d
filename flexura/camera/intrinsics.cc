#include "flexura/camera/intrinsics.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
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
double largest_radius_of_brown(const Distortion& distortion) {
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

// A polynomial of a degree up to 6.
struct Polynomial {
  std::array<double, 7> coefficients = {};  // Beginning with the constant one.
  std::size_t degree = 0;

  [[nodiscard]] double value(double x) const {
    double value = 0;
    for (std::size_t i = degree + 1; i-- > 0;) value = coefficients[i] + x * value;
    return value;
  }
  [[nodiscard]] Polynomial derivative() const {
    Polynomial result{.degree = degree - 1};
    for (std::size_t i = 1; i <= degree; ++i)
      result.coefficients[i - 1] = static_cast<double>(i) * coefficients[i];
    return result;
  }
};

Polynomial product_of(const Polynomial& a, const Polynomial& b) {
  Polynomial product{.degree = a.degree + b.degree};
  for (std::size_t i = 0; i <= a.degree; ++i)
    for (std::size_t j = 0; j <= b.degree; ++j)
      product.coefficients[i + j] += a.coefficients[i] * b.coefficients[j];
  return product;
}

struct SignChanges {
  std::array<double, 7> at = {};
  std::size_t count = 0;
};

// Returns where a polynomial changes its sign between two numbers, by Newton's method in a bracket.
double root_between(const Polynomial& polynomial, const Polynomial& slope, double low, double high) {
  const bool is_positive = polynomial.value(low) > 0;
  double x = 0.5 * (low + high);
  for (int step = 0; step < 200; ++step) {
    const double value = polynomial.value(x);
    ((value > 0) == is_positive ? low : high) = x;
    const double next = x - value / slope.value(x), last = x;
    x = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(x - last) <= 1e-15 * x) break;
  }
  return x;
}

// Returns the positive numbers up to `limit` at which the polynomial changes its sign, in order. Between the
// turning points the polynomial is monotone.
SignChanges sign_changes(const Polynomial& polynomial, double limit) {
  SignChanges changes;
  if (polynomial.degree == 0) return changes;
  const Polynomial slope = polynomial.derivative();
  SignChanges ends = sign_changes(slope, limit);
  ends.at[ends.count++] = limit;
  double begin = 0;
  for (std::size_t piece = 0; piece < ends.count; ++piece) {
    const double end = ends.at[piece];
    if ((polynomial.value(begin) > 0) != (polynomial.value(end) > 0))
      changes.at[changes.count++] = root_between(polynomial, slope, begin, end);
    begin = end;
  }
  return changes;
}

// Returns a number just before the first root of a polynomial that is positive at 0; infinite if there is no
// root up to `limit`.
double first_root(const Polynomial& polynomial, double limit) {
  constexpr double just_before = 1 - 1e-12;
  const SignChanges changes = sign_changes(polynomial, limit);
  return changes.count == 0 ? infinity : just_before * changes.at[0];
}

// The radius up to which r N(q) / D(q) increases.
double largest_radius_of_rational(const Distortion& k) {
  constexpr double beyond = 1e8;  // The square of the radius at 89.99 degrees.
  const Polynomial N{{1, k[0], k[1], k[4]}, 3}, D{{1, k[5], k[6], k[7]}, 3};
  // The derivative times D^2.
  Polynomial slope = product_of(N, D);
  const Polynomial upper = product_of(N.derivative(), D), lower = product_of(N, D.derivative());
  for (std::size_t i = 0; i <= upper.degree; ++i)
    slope.coefficients[i + 1] += 2 * (upper.coefficients[i] - lower.coefficients[i]);
  return std::sqrt(std::min(first_root(slope, beyond), first_root(D, beyond)));
}

double largest_radius_of_fisheye(const Distortion& k) {
  constexpr double right_angle = std::numbers::pi / 2;
  const double root = first_root({{1, 3 * k[0], 5 * k[1], 7 * k[2], 9 * k[3]}, 4}, right_angle * right_angle);
  return root == infinity ? infinity : std::tan(std::sqrt(root));
}

double largest_radius_of(const Distortion& distortion) {
  if (distortion.is_none()) return infinity;
  if (distortion.model() == LensModel::rational) return largest_radius_of_rational(distortion);
  return distortion.model() == LensModel::fisheye ? largest_radius_of_fisheye(distortion)
                                                  : largest_radius_of_brown(distortion);
}

// The angle of a direction from the optical axis, divided by its radius, as a function of q = r^2.
struct AngleShare {
  double value;  // atan(r) / r
  double slope;  // Derivative with respect to q.
};

AngleShare angle_share(double q) {
  constexpr double small = 0.02;  // The closed form of the derivative would cancel.
  if (q < small) {
    // The series 1 - q/3 + q^2/5 - ...
    AngleShare share{0, 0};
    constexpr int terms = 10;
    for (int i = terms; i > 0; --i) {
      const double sign = i % 2 == 0 ? 1 : -1;
      share.value = q * share.value + sign / (2 * i + 1);
      share.slope = q * share.slope + sign * i / (2 * i + 1);
    }
    share.value = 1 + q * share.value;
    return share;
  }
  const double r = std::sqrt(q), share = std::atan(r) / r;
  return {share, (1 / (1 + q) - share) / (2 * q)};
}

// The radial factor g(q), q = r^2.
struct Radial {
  double factor;
  double slope;  // Twice the derivative with respect to q.
};

Radial radial_of(double q, const Distortion& k) {
  if (k.model() == LensModel::fisheye) {
    const AngleShare share = angle_share(q);
    const double t = q * share.value * share.value;  // The square of the angle.
    const double scale = 1 + t * (k[0] + t * (k[1] + t * (k[2] + t * k[3]))),
                 scale_slope = k[0] + t * (2 * k[1] + t * (3 * k[2] + t * 4 * k[3]));
    return {share.value * scale,
            2 * (share.slope * scale + share.value * scale_slope * share.value / (1 + q))};
  }
  const double factor = 1 + q * (k[0] + q * (k[1] + q * k[4]));
  const double slope = 2 * (k[0] + q * (2 * k[1] + q * 3 * k[4]));
  if (k.model() == LensModel::brown) return {factor, slope};
  const double divisor = 1 + q * (k[5] + q * (k[6] + q * k[7])),
               divisor_slope = 2 * (k[5] + q * (2 * k[6] + q * 3 * k[7]));
  return {factor / divisor, (slope - factor / divisor * divisor_slope) / divisor};
}

// The coefficients p1 and p2.
std::array<double, 2> tangential_of(const Distortion& k) {
  if (k.model() == LensModel::fisheye) return {0, 0};
  return {k[2], k[3]};
}

// Returns the point that radial distortion maps to `desired`; if there is no such point, a point near the
// rim.
Eigen::Vector2d undistort_radially(const Eigen::Vector2d& desired, const Distortion& distortion,
                                   double largest_radius) {
  const double radius = desired.norm();
  if (!(radius > 0)) return desired;
  constexpr double beyond = 1e4;
  double low = 0, high = std::min(largest_radius, beyond);
  double r = std::min(radius, high);
  for (int step = 0; step < 100 && high - low > 1e-15 * high; ++step) {
    const double q = r * r;
    const Radial radial = radial_of(q, distortion);
    const double excess = r * radial.factor - radius, slope = radial.factor + q * radial.slope;
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

Distorted distort(const Eigen::Vector2d& normal, const Distortion& distortion) {
  const auto [p1, p2] = tangential_of(distortion);
  const double a = normal.x(), b = normal.y(), q = a * a + b * b;
  const auto [radial, slope] = radial_of(q, distortion);
  Distorted result;
  result.point = {a * radial + 2 * p1 * a * b + p2 * (q + 2 * a * a),
                  b * radial + p1 * (q + 2 * b * b) + 2 * p2 * a * b};
  const double mixed = a * b * slope + 2 * p1 * a + 2 * p2 * b;
  result.by_point << radial + a * a * slope + 2 * p1 * b + 6 * p2 * a, mixed, mixed,
      radial + b * b * slope + 6 * p1 * b + 2 * p2 * a;
  return result;
}

// The derivative of the distorted coordinates with respect to the coefficients.
Eigen::Matrix<double, 2, static_cast<int>(Distortion::most)> by_coefficients(const Eigen::Vector2d& normal,
                                                                             const Distortion& k) {
  const double a = normal.x(), b = normal.y(), q = normal.squaredNorm();
  Eigen::Matrix<double, 2, static_cast<int>(Distortion::most)> result =
      Eigen::Matrix<double, 2, static_cast<int>(Distortion::most)>::Zero();
  if (k.model() == LensModel::fisheye) {
    const double share = angle_share(q).value, t = q * share * share;
    double part = share;
    for (Eigen::Index i = 0; i < 4; ++i) result.col(i) = (part *= t) * normal;
    return result;
  }
  double divisor = 1;
  if (k.model() == LensModel::rational) {
    divisor = 1 + q * (k[5] + q * (k[6] + q * k[7]));
    const double factor = radial_of(q, k).factor;
    double part = -factor / divisor;
    for (Eigen::Index i = 5; i < 8; ++i) result.col(i) = (part *= q) * normal;
  }
  result.col(0) = q / divisor * normal;
  result.col(1) = q * q / divisor * normal;
  result.col(2) << 2 * a * b, q + 2 * b * b;
  result.col(3) << q + 2 * a * a, 2 * a * b;
  result.col(4) = q * q * q / divisor * normal;
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
    require(std::isfinite(coefficient), "the distortion must have finite coefficients");
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
  const double fx = intrinsics_.fx, fy = intrinsics_.fy, a = normal.x(), b = normal.y();
  Projection result;
  result.pixel = *pixel;
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << 1, 0, -a, 0, 1, -b;
  result.by_point = Eigen::Vector2d(fx, fy).asDiagonal() * distorted.by_point * by_point / p_CP.z();
  result.by_intrinsics.leftCols<4>() << distorted.point.x(), 0, 1, 0, 0, distorted.point.y(), 0, 1;
  result.by_intrinsics.rightCols<static_cast<int>(Distortion::most)>() =
      Eigen::Vector2d(fx, fy).asDiagonal() * by_coefficients(normal, intrinsics_.distortion);
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
    const double q = a * a + b * b;
    if (!(q <= largest_radius_ * largest_radius_)) return false;
    const auto [p1, p2] = tangential_of(intrinsics_.distortion);
    const auto [radial, slope] = radial_of(q, intrinsics_.distortion);
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
