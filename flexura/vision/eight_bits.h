#pragma once

#include <cstdint>

#include "flexura/base/image.h"

namespace flexura {

/// Converts a picture to 8 bits per value. The value `white`, and all larger values, become 255. Throws
/// std::invalid_argument if `white` is below 1.
[[nodiscard]] Image<std::uint8_t> eight_bits(const Picture& picture, int white);
[[nodiscard]] Image<std::uint8_t> eight_bits(const Image<std::uint16_t>& picture, int white);

}  // namespace flexura
