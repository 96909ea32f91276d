#pragma once

#include <vector>

namespace flexura {

/// Returns one side of a symmetric kernel, the middle weight first: Gaussian weights up to 3.5 standard
/// deviations (rounded up). Their sum is 1 and their variance exactly `deviation`^2, px^2. A sampled narrow
/// Gaussian of that variance would have another one. For deviation 0 only the middle weight.
[[nodiscard]] std::vector<float> psf_weights(double deviation);

}  // namespace flexura
