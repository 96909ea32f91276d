#pragma once

#include <span>

#include "flexura/math/simd_path.h"

namespace flexura {

/// The sine and cosine of each angle, rad, by the routine that the batch functions use. Up to |angle| = 10
/// within 1.5 units in the last place, up to 1e6 within 2.5; beyond, and for what is not finite, std::sin and
/// std::cos. std::invalid_argument: spans of different sizes, a path that is not available.
void sines_and_cosines(std::span<const double> angles, std::span<double> sines, std::span<double> cosines,
                       SimdPath path = best_simd_path());

}  // namespace flexura
