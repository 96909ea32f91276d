#pragma once

#include <cstdint>
#include <functional>

#include "flexura/base/image.h"
#include "flexura/camera/view.h"
#include "flexura/model/arm.h"
#include "flexura/rig/setup.h"

namespace flexura {

/// Returns a function that renders the file's arm model in gray and without noise. These pictures are the
/// paper's ideal images (section 2).
[[nodiscard]] std::function<Image<std::uint8_t>(const View&, const ArmState&)> ideal_pictures(
    const Setup& setup);

}  // namespace flexura
