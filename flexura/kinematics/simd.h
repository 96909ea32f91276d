#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace flexura {

/// The instruction sets that the batch functions are compiled for. Every one gives the same bits
/// (docs/kinematic-model.md, "Many arms at once").
enum class SimdPath {
  baseline,  ///< What every processor of the build's architecture has: SSE2 on x86-64, two numbers in each
             ///< instruction.
  avx2,      ///< Four.
  avx512,    ///< Eight.
};

/// "baseline", "avx2" or "avx512".
[[nodiscard]] std::string_view name_of(SimdPath path);

/// The paths that this build holds and this processor can run, narrowest first; the first is the baseline.
[[nodiscard]] std::vector<SimdPath> available_simd_paths();

/// The widest of them.
[[nodiscard]] SimdPath best_simd_path();

/// The sine and cosine of each angle, rad, by the routine that the batch functions use. Up to |angle| = 10
/// within 1.5 units in the last place, up to 1e6 within 2.5; beyond, and for what is not finite, std::sin and
/// std::cos. std::invalid_argument: spans of different sizes, a path that is not available.
void sines_and_cosines(std::span<const double> angles, std::span<double> sines, std::span<double> cosines,
                       SimdPath path = best_simd_path());

}  // namespace flexura
