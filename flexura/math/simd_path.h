#pragma once

#include <string_view>
#include <vector>

namespace flexura {

/// Instruction sets of functions that process several numbers at once. Results are bitwise equal for all
/// instruction sets.
enum class SimdPath {
  /// Available on every processor of the build's architecture. On x86-64: SSE2, two doubles per instruction.
  baseline,
  avx2,    ///< Four doubles per instruction.
  avx512,  ///< Eight doubles per instruction; needs AVX-512 F and BW.
};

/// Returns "baseline", "avx2" or "avx512".
[[nodiscard]] std::string_view name_of(SimdPath path);

/// Returns the instruction sets that this build contains and this processor supports, from the narrowest (the
/// baseline) to the widest.
[[nodiscard]] std::vector<SimdPath> available_simd_paths();

/// Returns the widest of the available_simd_paths().
[[nodiscard]] SimdPath best_simd_path();

/// Throws std::invalid_argument if `path` is not among the available_simd_paths().
void require_simd_path(SimdPath path);

}  // namespace flexura
