#pragma once

#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/view.h"
#include "flexura/vision/picture_file.h"

namespace flexura {

/// Whether a camera's description is one for pictures of another size than the view's; for which, as far as
/// its principal point tells.
[[nodiscard]] std::optional<std::string> doubt_of_size(const View& view);

/// Whether much of a picture is as bright as it can tell; `gray` is its brightness. A border beside what is
/// cut off at white is drawn aside.
[[nodiscard]] std::optional<std::string> doubt_of_exposure(const Photograph& picture,
                                                           const Image<std::uint8_t>& gray);

}  // namespace flexura
