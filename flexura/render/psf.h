#pragma once

#include <vector>

namespace flexura {

/// Returns one side of a symmetric kernel of Gaussian weights, the middle weight first, up to 3.5 standard
/// deviations (rounded up). The sum of the whole kernel is 1, and its variance is exactly `deviation`^2,
/// px^2. A sampled narrow Gaussian would have another variance than the Gaussian. For deviation 0 only the
/// middle weight is returned.
[[nodiscard]] std::vector<float> psf_weights(double deviation);

}  // namespace flexura
