#pragma once

namespace flexura {

// Smooth functions of an angle t, rad, in the formulas of arcs and rotations. Each function is even in t and
// has a finite limit at 0. The evaluation has no cancellation near 0, even for denormal numbers. Near a zero
// of a function at t > 0, the error is a few units in the last place of the larger term of the formula.

/// sin t / t; 1 at 0.
[[nodiscard]] double sinc(double t);
/// (1 - cos t) / t^2; 1/2 at 0.
[[nodiscard]] double cosc(double t);
/// (t - sin t) / t^3; 1/6 at 0.
[[nodiscard]] double sinc_deficit(double t);
/// sinc'(t) / t = (t cos t - sin t) / t^3; -1/3 at 0.
[[nodiscard]] double sinc_slope(double t);

/// Values of all these functions at one angle t.
struct BendFunctions {
  double sinc, cosc, sinc_deficit, sinc_slope;
  double cosc_slope;  ///< cosc'(t) / t = (t sin t - 2 (1 - cos t)) / t^4; -1/12 at 0.
};
/// Returns all functions at t. The values are bitwise equal to the values of the single functions, but sine
/// and cosine are computed only once.
[[nodiscard]] BendFunctions bend_functions(double t);

}  // namespace flexura
