#include "flexura/math/series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace flexura {
namespace {

// Power series in long double (64 bits), which up to |t| = 1 lose nothing. Beyond, closed forms in long
// double, which there lose at most 3 of its 11 spare bits. No code in common with the tested functions.
long double alternating_series(long double t, int first_factorial, bool with_factor) {
  long double factorial = 1.0L;
  for (int k = 2; k <= first_factorial; ++k) factorial *= k;
  long double power = 1.0L;
  long double sum = 0.0L;
  for (int k = 0; k < 15; ++k) {
    sum += (with_factor ? 2 * k + 2 : 1) * power / factorial;
    power *= -t * t;
    factorial *= static_cast<long double>((first_factorial + 2 * k + 1) * (first_factorial + 2 * k + 2));
  }
  return sum;
}

long double reference_sinc(long double t) {
  return t < 1 ? alternating_series(t, 1, false) : std::sin(t) / t;
}
long double reference_cosc(long double t) {
  const long double half = std::sin(t / 2);
  return t < 1 ? alternating_series(t, 2, false) : 2 * half * half / (t * t);
}
long double reference_sinc_deficit(long double t) {
  return t < 1 ? alternating_series(t, 3, false) : (t - std::sin(t)) / (t * t * t);
}
long double reference_sinc_slope(long double t) {
  return t < 1 ? -alternating_series(t, 3, true) : (t * std::cos(t) - std::sin(t)) / (t * t * t);
}
long double reference_cosc_slope(long double t) {
  const long double h = t / 2;  // 4 sin h (h cos h - sin h) / t^4, free of cancellation near 2 pi.
  return 0.25L * (t < 1 ? alternating_series(h, 1, false) : std::sin(h) / h) * reference_sinc_slope(h);
}

// Log-spaced bends from 1e-12 to 4 pi, dense around the switch, plus 0 and numbers below all these.
std::vector<double> bends() {
  std::vector<double> result = {0.0,  std::numeric_limits<double>::denorm_min(), 1e-310, 1e-200, 1e-100,
                                1e-30};
  const double top = 4 * std::numbers::pi;
  for (int i = 0; i <= 20000; ++i) result.push_back(1e-12 * std::pow(top / 1e-12, i / 20000.0));
  for (int i = -500; i <= 500; ++i) result.push_back(1.5 + i * 1e-4);
  return result;
}

TEST(Series, SincAndCoscAreExactTo1em14RelativeForAllBends) {
  for (const double t : bends()) {
    const auto sinc_expected = static_cast<double>(reference_sinc(t));
    const auto cosc_expected = static_cast<double>(reference_cosc(t));
    ASSERT_LE(std::abs(sinc(t) - sinc_expected), 1e-15 * std::abs(sinc_expected)) << t;
    ASSERT_LE(std::abs(cosc(t) - cosc_expected), 1e-15 * std::abs(cosc_expected)) << t;
  }
}

TEST(Series, TheDeficitIsExactTo1em14RelativeForAllBends) {
  for (const double t : bends()) {
    const auto expected = static_cast<double>(reference_sinc_deficit(t));
    ASSERT_LE(std::abs(sinc_deficit(t) - expected), 2e-15 * expected) << t;
  }
}

// A slope crosses zero (near 4.49 and 7.73; 2 pi, 8.99 and 12.57): there the error is relative to its
// envelope.
TEST(Series, TheSlopesAreExactTo1em14RelativeUpToTheirZeros) {
  for (const double t : bends()) {
    const auto s = static_cast<double>(reference_sinc_slope(t));
    const auto c = static_cast<double>(reference_cosc_slope(t));
    const double s_scale = t < 3 ? std::abs(s) : 1 / (t * t);
    const double c_scale = t < 6 ? std::abs(c) : 1 / (t * t * t);
    ASSERT_LE(std::abs(sinc_slope(t) - s), 2e-15 * s_scale) << t;
    const BendFunctions all = bend_functions(t);
    ASSERT_LE(std::abs(all.cosc_slope - c), 2e-15 * c_scale) << t;
    ASSERT_TRUE(all.sinc == sinc(t) && all.cosc == cosc(t) && all.sinc_deficit == sinc_deficit(t) &&
                all.sinc_slope == sinc_slope(t))
        << t;
  }
}

}  // namespace
}  // namespace flexura
