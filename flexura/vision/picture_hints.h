#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/intrinsics.h"

namespace flexura {

/// Returns a hint if the intrinsics of a lens seem to belong to pictures of another size than width x height
/// px. The hint states the size that the principal point suggests, if any.
[[nodiscard]] std::optional<std::string> hint_of_size(const Lens& lens, int width, int height);

/// Returns a hint if a large part of a picture is saturated, because saturation shifts borders. It must not
/// be used for masks.
[[nodiscard]] std::optional<std::string> hint_of_exposure(const Image<std::uint8_t>& gray);

}  // namespace flexura
