#pragma once

#include <vector>

namespace flexura {

/// Returns one side of a symmetric kernel of Gaussian weights, from the middle weight to 3.5 standard
/// deviations (rounded up). The sum of the whole kernel is 1, and its variance is exactly `deviation`^2,
/// px^2. Samples of a narrow Gaussian would not have this variance. For deviation 0, returns only the middle
/// weight.
[[nodiscard]] std::vector<float> psf_weights(double deviation);

}  // namespace flexura
