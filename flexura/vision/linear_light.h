#pragma once

#include "flexura/vision/picture_file.h"

namespace flexura {

/// Returns the linear light of a gamma-encoded picture, whose values are light to the power 1/gamma, both
/// relative to full scale. The result has `words` from 0 to `white` = 65535, and the corresponding `bytes`.
/// Borders are where the light is half-way between both sides; in gamma-encoded values this would be another
/// position (docs/vision.md, "Gamma"). Masks, and pictures of gamma 1, are unchanged. Throws
/// std::invalid_argument for a gamma that is not positive and finite.
[[nodiscard]] Photograph linear_light(Photograph picture, double gamma);

}  // namespace flexura
