#pragma once

#include <cstdint>

#include "flexura/base/image.h"

namespace flexura {

/// A picture in 8 bits, whatever it had; `white`: its largest value, if it had more.
[[nodiscard]] Image<std::uint8_t> eight_bits(const Picture& picture, int white);

}  // namespace flexura
