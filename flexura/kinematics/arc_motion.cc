#include "flexura/kinematics/arc_motion.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace flexura {
namespace {

// With t = |bend|: S = sin t/t, A = (1 - cos t)/t^2, C = (1 - S)/t^2, D = (1/2 - A)/t^2. Their derivatives
// need no further division: S'/t = C - A and A'/t = 2 D - C.
struct Coefficients {
  double S, A, C, D;
};

// Terms 1/(2k + first)! with alternating signs; for t^2 < 1/4 seven leave an error below 1e-17.
template <int first>
constexpr std::array<double, 7> alternating_factorials() {
  std::array<double, 7> terms{};
  double factorial = 1.0;
  for (int n = 2; n <= first; ++n) factorial *= n;
  double sign = 1.0;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const int n = 2 * static_cast<int>(k) + first;
    terms[k] = sign / factorial;
    factorial *= (n + 1) * (n + 2);
    sign = -sign;
  }
  return terms;
}

double polynomial(const std::array<double, 7>& terms, double x) {
  double sum = terms.back();
  for (std::size_t k = terms.size() - 1; k-- > 0;) sum = terms[k] + x * sum;
  return sum;
}

Coefficients coefficients(double t_squared) {
  constexpr double series_end = 0.25;
  if (t_squared < series_end) {
    static constexpr auto c_series = alternating_factorials<3>();
    static constexpr auto d_series = alternating_factorials<4>();
    const double C = polynomial(c_series, t_squared);
    const double D = polynomial(d_series, t_squared);
    return {1.0 - t_squared * C, 0.5 - t_squared * D, C, D};
  }
  const double t = std::sqrt(t_squared);
  const double s = std::sin(0.5 * t);
  const double c = std::cos(0.5 * t);
  const double inverse = 1.0 / t_squared;
  const double S = 2.0 * s * c / t;
  const double A = 2.0 * s * s * inverse;
  return {S, A, (1.0 - S) * inverse, (0.5 - A) * inverse};
}

}  // namespace

ArcMotion arc_motion(const Eigen::Vector2d& bend, double length) {
  const double x = bend.x();
  const double y = bend.y();
  const auto [S, A, C, D] = coefficients(x * x + y * y);
  const double slope_S = length * (C - A);
  const double slope_A = length * (2.0 * D - C);
  ArcMotion end;
  end.rotation << 1.0 - A * x * x, -A * x * y, S * x,  //
      -A * x * y, 1.0 - A * y * y, S * y,              //
      -S * x, -S * y, 1.0 - A * (x * x + y * y);
  end.position << length * A * x, length * A * y, length * S;
  end.linear << length * A + slope_A * x * x, slope_A * x * y,  //
      slope_A * x * y, length * A + slope_A * y * y,            //
      slope_S * x, slope_S * y;
  end.angular << -C * x * y, C * x * x - 1.0,  //
      1.0 - C * y * y, C * x * y,              //
      -A * y, A * x;
  return end;
}

}  // namespace flexura
