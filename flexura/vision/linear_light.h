#pragma once

#include "flexura/vision/picture_file.h"

namespace flexura {

/// The light behind a picture whose values are light to the power 1/gamma, of full scale: `words` from 0 to
/// `white` = 65535, and `bytes` of the same. Borders are found where the light is half-way, which is
/// elsewhere than where such values are (docs/vision.md, "Gamma"). Masks, and pictures of gamma 1, stay as
/// they are. std::invalid_argument: a gamma that is not positive and finite.
[[nodiscard]] Photograph linear_light(Photograph picture, double gamma);

}  // namespace flexura
