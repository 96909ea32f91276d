#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/intrinsics.h"

namespace flexura {

/// Returns a hint if a lens seems to be described for pictures of another size than these, px. The hint names
/// that size as far as the principal point indicates it.
[[nodiscard]] std::optional<std::string> hint_of_size(const Lens& lens, int width, int height);

/// Returns a hint if much of a picture is saturated: clipping at white shifts borders. For pictures, not for
/// masks.
[[nodiscard]] std::optional<std::string> hint_of_exposure(const Image<std::uint8_t>& gray);

}  // namespace flexura
