#pragma once

namespace flexura {

// The smooth functions of a bend angle t (rad) that arcs and rotations are made of. Each is even in t, has a
// finite limit at 0 and is evaluated without cancellation, at 0 and at denormal numbers too. Where a value
// crosses zero inside (0, inf) the error is a few units in the last place of the larger term beside it.

/// sin t / t; 1 at 0.
[[nodiscard]] double sinc(double t);
/// (1 - cos t) / t^2; 1/2 at 0.
[[nodiscard]] double cosc(double t);
/// (t - sin t) / t^3; 1/6 at 0.
[[nodiscard]] double sinc_deficit(double t);
/// sinc'(t) / t = (t cos t - sin t) / t^3; -1/3 at 0.
[[nodiscard]] double sinc_slope(double t);

/// All at one angle, with the sines and cosines that they share.
struct BendFunctions {
  double sinc, cosc, sinc_deficit, sinc_slope;
  double cosc_slope;  ///< cosc'(t) / t = (t sin t - 2 (1 - cos t)) / t^4; -1/12 at 0.
};
/// Those at t, to the same bits.
[[nodiscard]] BendFunctions bend_functions(double t);

}  // namespace flexura
