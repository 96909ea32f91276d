#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/intrinsics.h"

namespace flexura {

/// Whether a lens is described for pictures of another size than these, px; for which, as far as its
/// principal point tells.
[[nodiscard]] std::optional<std::string> hint_of_size(const Lens& lens, int width, int height);

/// Whether much of a picture is as bright as it can tell: a border beside what is cut off at white is seen
/// aside. For pictures, not for masks.
[[nodiscard]] std::optional<std::string> hint_of_exposure(const Image<std::uint8_t>& gray);

}  // namespace flexura
