#pragma once

namespace flexura {

// Smooth functions of a bend angle t (rad) in the formulas of arcs and rotations. Each is even in t, has a
// finite limit at 0 and is evaluated without cancellation, even at 0 and at denormal numbers. Where a value
// crosses zero inside (0, inf) the error is a few units in the last place of the larger term there.

/// sin t / t; 1 at 0.
[[nodiscard]] double sinc(double t);
/// (1 - cos t) / t^2; 1/2 at 0.
[[nodiscard]] double cosc(double t);
/// (t - sin t) / t^3; 1/6 at 0.
[[nodiscard]] double sinc_deficit(double t);
/// sinc'(t) / t = (t cos t - sin t) / t^3; -1/3 at 0.
[[nodiscard]] double sinc_slope(double t);

/// All functions at one angle, with shared sines and cosines.
struct BendFunctions {
  double sinc, cosc, sinc_deficit, sinc_slope;
  double cosc_slope;  ///< cosc'(t) / t = (t sin t - 2 (1 - cos t)) / t^4; -1/12 at 0.
};
/// Returns the functions at t, with equal bits.
[[nodiscard]] BendFunctions bend_functions(double t);

}  // namespace flexura
