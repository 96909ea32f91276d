#pragma once

#include <cstdint>

#include "flexura/base/image.h"

namespace flexura {

/// A picture in 8 bits: what is `white` in it, its largest value, is 255, and so is what is more.
/// std::invalid_argument: white below 1.
[[nodiscard]] Image<std::uint8_t> eight_bits(const Picture& picture, int white);
[[nodiscard]] Image<std::uint8_t> eight_bits(const Image<std::uint16_t>& picture, int white);

}  // namespace flexura
