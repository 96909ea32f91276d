#pragma once

#include <cstdint>

#include "flexura/base/image.h"

namespace flexura {

/// The largest value of so many bits, 1 to 16.
[[nodiscard]] constexpr int white_of(std::int64_t bits) { return (1 << bits) - 1; }

/// A picture in 8 bits: what is `white` in it, its largest value, is 255, and so is what is more.
/// std::invalid_argument: white below 1.
[[nodiscard]] Image<std::uint8_t> eight_bits(const Picture& picture, int white);
[[nodiscard]] Image<std::uint8_t> eight_bits(const Image<std::uint16_t>& picture, int white);

}  // namespace flexura
