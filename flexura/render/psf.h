#pragma once

#include <vector>

namespace flexura {

/// One side of a symmetric kernel, the middle weight first: Gaussian weights up to 3.5 standard deviations
/// (rounded up), of unit sum and with exactly the variance `deviation`^2, px^2. Sampled from a Gaussian of
/// that variance itself, a narrow kernel's would differ. The middle weight alone where the deviation is 0.
[[nodiscard]] std::vector<float> psf_weights(double deviation);

}  // namespace flexura
