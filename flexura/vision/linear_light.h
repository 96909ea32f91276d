#pragma once

#include "flexura/vision/picture_file.h"

namespace flexura {

/// Returns the linear light of a gamma-encoded picture, whose values are light to the power 1/gamma, both
/// relative to full scale. The result has `words` from 0 to `white` = 65535, and the corresponding `bytes`. A
/// border is where the light is half-way between both sides. In gamma-encoded values, it would appear at
/// another position (docs/vision.md, "Gamma"). Masks, and pictures with gamma 1, remain unchanged. Throws
/// std::invalid_argument for a gamma that is not positive and finite.
[[nodiscard]] Photograph linear_light(Photograph picture, double gamma);

}  // namespace flexura
