#pragma once

#include <string_view>
#include <vector>

namespace flexura {

/// Instruction sets of functions for many numbers at once. All give equal bits (docs/kinematic-model.md,
/// "Many arms at once").
enum class SimdPath {
  baseline,  ///< On every processor of the build's architecture: SSE2 on x86-64, two doubles per instruction.
  avx2,      ///< Four doubles per instruction.
  avx512,    ///< Eight doubles per instruction. AVX-512 F and BW.
};

/// Returns "baseline", "avx2" or "avx512".
[[nodiscard]] std::string_view name_of(SimdPath path);

/// Returns the paths of this build that this processor can run, narrowest first; the first is the baseline.
[[nodiscard]] std::vector<SimdPath> available_simd_paths();

/// Returns the widest of them.
[[nodiscard]] SimdPath best_simd_path();

/// Throws std::invalid_argument if the path is not one of them.
void require_simd_path(SimdPath path);

}  // namespace flexura
