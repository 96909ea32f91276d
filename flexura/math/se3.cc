#include "flexura/math/se3.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "flexura/math/factorial.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

// jacobian = I + the sum over n = 1..4 of c_n ad^n. The c_n are functions of the angle t: (4 - t sin t - 4
// cos t) / 2 t^2, (4 t - 5 sin t + t cos t) / 2 t^3, (2 - t sin t - 2 cos t) / 2 t^4 and (2 t - 3 sin t + t
// cos t) / 2 t^5.
struct JacobianCoefficients {
  std::array<double, 4> value;
  std::array<double, 4> slope;  // dc_n/dt / t.
};

// For t^2 below this limit power series are used, with a remainder below 1e-20.
constexpr double square_limit = 1;
constexpr std::size_t jacobian_terms = 10;

// c_n as a series in t^2.
constexpr std::array<std::array<double, jacobian_terms>, 4> jacobian_series = [] {
  std::array<std::array<double, jacobian_terms>, 4> c{};
  for (std::size_t n = 1; n <= 4; ++n) {
    const std::size_t first = n <= 2 ? 1 : 2, odd = n % 2 == 0 ? 1 : 0;
    for (std::size_t i = 0; i < jacobian_terms; ++i) {
      const std::size_t k = first + i;
      const double factor = static_cast<double>(2 * k) - (n <= 2 ? 4.0 : 2.0);
      c[n - 1][i] = (k % 2 == 0 ? 0.5 : -0.5) * factor / factorial(2 * k + odd);
    }
  }
  return c;
}();

JacobianCoefficients coefficients(double square) {
  JacobianCoefficients c{};
  if (square < square_limit) {
    for (std::size_t n = 0; n < 4; ++n) {
      for (std::size_t i = jacobian_terms; i-- > 0;) c.value[n] = jacobian_series[n][i] + square * c.value[n];
      for (std::size_t i = jacobian_terms; i-- > 1;)
        c.slope[n] = 2 * static_cast<double>(i) * jacobian_series[n][i] + square * c.slope[n];
    }
    return c;
  }
  const double t = std::sqrt(square), sine = std::sin(t), cosine = std::cos(t);
  c.value = {(4 - t * sine - 4 * cosine) / (2 * square), (4 * t - 5 * sine + t * cosine) / (2 * square * t),
             (2 - t * sine - 2 * cosine) / (2 * square * square),
             (2 * t - 3 * sine + t * cosine) / (2 * square * square * t)};
  c.slope = {((3 * sine - t * cosine) / (2 * t) - 2 * c.value[0]) / square,
             ((4 - 4 * cosine - t * sine) / (2 * square) - 3 * c.value[1]) / square,
             ((sine - t * cosine) / (2 * square * t) - 4 * c.value[2]) / square,
             ((2 - 2 * cosine - t * sine) / (2 * square * square) - 5 * c.value[3]) / square};
  return c;
}

}  // namespace

Vector6d bracket(const Vector6d& a, const Vector6d& b) {
  Vector6d result;
  result << a.tail<3>().cross(b.head<3>()) + a.head<3>().cross(b.tail<3>()), a.tail<3>().cross(b.tail<3>());
  return result;
}

Matrix6d ad(const Vector6d& a) {
  Matrix6d result;
  result.topLeftCorner<3, 3>() = skew(a.tail<3>());
  result.bottomRightCorner<3, 3>() = result.topLeftCorner<3, 3>();
  result.topRightCorner<3, 3>() = skew(a.head<3>());
  result.bottomLeftCorner<3, 3>().setZero();
  return result;
}

Matrix6d bracket_form(const Vector6d& W) {
  Matrix6d result;
  result.topLeftCorner<3, 3>().setZero();
  result.topRightCorner<3, 3>() = -skew(W.head<3>());
  result.bottomLeftCorner<3, 3>() = result.topRightCorner<3, 3>();
  result.bottomRightCorner<3, 3>() = -skew(W.tail<3>());
  return result;
}

Matrix6d adjoint(const Pose& X_AB) {
  Matrix6d result;
  result.topLeftCorner<3, 3>() = X_AB.rotation;
  result.bottomRightCorner<3, 3>() = X_AB.rotation;
  result.topRightCorner<3, 3>() = skew(X_AB.position) * X_AB.rotation;
  result.bottomLeftCorner<3, 3>().setZero();
  return result;
}

Pose se3_exp(const Vector6d& twist) {
  return {so3_exp(twist.tail<3>()), so3_left_jacobian(twist.tail<3>()) * twist.head<3>()};
}

TwistExponential::TwistExponential(const Vector6d& given)
    : twist(given), pose(se3_exp(given)), angle_squared_(given.tail<3>().squaredNorm()), ad_(ad(given)) {
  const auto c = coefficients(angle_squared_).value;
  // The powers of ad in 3 x 3 blocks are [W^n, Q_n; 0, W^n].
  const Eigen::Matrix3d W = ad_.topLeftCorner<3, 3>(), V = ad_.topRightCorner<3, 3>();
  const Eigen::Matrix3d W2 = W * W, mixed = W * V;
  const Eigen::Matrix3d Q2 = mixed + V * W, Q3 = W * Q2 + V * W2, Q4 = W * Q3 - angle_squared_ * V * W;
  Eigen::Matrix3d corner = (c[0] - c[2] * angle_squared_) * W + (c[1] - c[3] * angle_squared_) * W2;
  corner.diagonal().array() += 1;
  jacobian.topLeftCorner<3, 3>() = corner;
  jacobian.bottomRightCorner<3, 3>() = corner;
  jacobian.topRightCorner<3, 3>() = c[0] * V + c[1] * Q2 + c[2] * Q3 + c[3] * Q4;
  jacobian.bottomLeftCorner<3, 3>().setZero();
}

Matrix6d TwistExponential::jacobian_form(const Vector6d& W) const {
  const JacobianCoefficients c = coefficients(angle_squared_);
  // u_p = (ad^T)^p W, as columns.
  std::array<Vector6d, 5> u;
  u[0] = W;
  for (std::size_t p = 1; p < 5; ++p) u[p] = ad_.transpose() * u[p - 1];
  // For c_n: d(t)/da = w . a_w / t. For ad^n: the sum over p of ad^p ad(a) ad^(n-1-p).
  Vector6d by_angle = Vector6d::Zero();
  for (std::size_t n = 1; n < 5; ++n) by_angle += c.slope[n - 1] * u[n];
  Matrix6d form = Matrix6d::Zero();
  for (std::size_t q = 4; q-- > 0;) {
    Vector6d sum = Vector6d::Zero();
    for (std::size_t p = 0; p + q < 4; ++p) sum += c.value[p + q] * u[p];
    if (q < 3) form = form * ad_;
    form += bracket_form(sum);
  }
  form.bottomRows<3>() += twist.tail<3>() * by_angle.transpose();
  return form;
}

}  // namespace flexura
