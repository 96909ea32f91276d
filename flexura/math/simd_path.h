#pragma once

#include <string_view>
#include <vector>

namespace flexura {

/// The instruction sets that functions for many numbers at once are compiled for. Every one gives the same
/// bits (docs/kinematic-model.md, "Many arms at once").
enum class SimdPath {
  baseline,  ///< What every processor of the build's architecture has: SSE2 on x86-64, two doubles in each
             ///< instruction.
  avx2,      ///< Four.
  avx512,    ///< Eight. AVX-512 F and BW.
};

/// "baseline", "avx2" or "avx512".
[[nodiscard]] std::string_view name_of(SimdPath path);

/// The paths that this build holds and this processor can run, narrowest first; the first is the baseline.
[[nodiscard]] std::vector<SimdPath> available_simd_paths();

/// The widest of them.
[[nodiscard]] SimdPath best_simd_path();

/// std::invalid_argument when the path is not one of them.
void require_simd_path(SimdPath path);

}  // namespace flexura
