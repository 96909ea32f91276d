#include "flexura/math/series.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "flexura/math/factorial.h"

namespace flexura {
namespace {

// For |t| below this limit, power series replace closed forms that have cancellation. At the limit the closed
// forms are still accurate to a few units in the last place, and the remainder after `terms` terms is below
// 1e-20.
constexpr double series_limit = 1.5;
constexpr std::size_t terms = 13;
using Coefficients = std::array<double, terms>;

constexpr double sign(std::size_t k) { return k % 2 == 0 ? 1.0 : -1.0; }

// (t - sin t) / t^3 = sum (-1)^k t^2k / (2k + 3)!
constexpr Coefficients sinc_deficit_series = [] {
  Coefficients c{};
  for (std::size_t k = 0; k < terms; ++k) c[k] = sign(k) / factorial(2 * k + 3);
  return c;
}();

// (t cos t - sin t) / t^3 = -sum (-1)^k (2k + 2) t^2k / (2k + 3)!
constexpr Coefficients sinc_slope_series = [] {
  Coefficients c{};
  for (std::size_t k = 0; k < terms; ++k) {
    c[k] = -sign(k) * static_cast<double>(2 * k + 2) / factorial(2 * k + 3);
  }
  return c;
}();

double even_series(const Coefficients& c, double t) {
  const double x = t * t;
  double sum = c.back();
  for (std::size_t k = terms - 1; k-- > 0;) sum = c[k] + x * sum;
  return sum;
}

// The following functions take sinc(t), which their callers have already computed.
double deficit(double t, double sinc_t) {
  return std::abs(t) < series_limit ? even_series(sinc_deficit_series, t) : (1.0 - sinc_t) / (t * t);
}
double slope(double t, double sinc_t) {
  return std::abs(t) < series_limit ? even_series(sinc_slope_series, t) : (std::cos(t) - sinc_t) / (t * t);
}

}  // namespace

double sinc(double t) { return t == 0.0 ? 1.0 : std::sin(t) / t; }

double cosc(double t) {
  const double half = sinc(0.5 * t);
  return 0.5 * half * half;
}

double sinc_deficit(double t) { return deficit(t, sinc(t)); }

double sinc_slope(double t) { return slope(t, sinc(t)); }

BendFunctions bend_functions(double t) {
  const double whole = sinc(t), half = sinc(0.5 * t);
  return {whole, 0.5 * half * half, deficit(t, whole), slope(t, whole), 0.25 * half * slope(0.5 * t, half)};
}

}  // namespace flexura
