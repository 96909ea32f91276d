#pragma once

#include "flexura/vision/picture_file.h"

namespace flexura {

/// Returns the linear light of a picture whose values are light to the power 1/gamma, of full scale: `words`
/// from 0 to `white` = 65535, and the corresponding `bytes`. Borders are at half of the light, which is
/// elsewhere in gamma-encoded values (docs/vision.md, "Gamma"). Masks, and pictures of gamma 1, are
/// unchanged. Throws std::invalid_argument for a gamma that is not positive and finite.
[[nodiscard]] Photograph linear_light(Photograph picture, double gamma);

}  // namespace flexura
