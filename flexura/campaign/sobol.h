#pragma once

#include <cstddef>
#include <cstdint>

namespace flexura {

/// Largest number of dimensions of a Sobol sequence.
inline constexpr std::size_t most_sobol_dimensions = 32;

/// Returns coordinate `dimension` (below most_sobol_dimensions) of point `index` of the Sobol sequence, as a
/// share of 2^32. The points are in their natural order, not in that of the Gray code; point 0 is 0. The
/// first 2^32 points are distinct. Direction numbers: S. Joe, F. Kuo, "Constructing Sobol sequences with
/// better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008). Throws std::out_of_range beyond the
/// last dimension.
[[nodiscard]] std::uint32_t sobol(std::size_t dimension, std::uint32_t index);

}  // namespace flexura
