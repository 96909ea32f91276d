#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"

namespace flexura {

/// Places among `cameras` of two that a task names, or of the first two where it names none; checked before.
[[nodiscard]] std::array<std::size_t, 2> two_cameras(const std::vector<std::string>& names,
                                                     const std::vector<CameraConfig>& cameras);

/// Reports what keeps the task at `path` from having two cameras.
void check_two_cameras(const std::vector<std::string>& names, const std::vector<CameraConfig>& cameras,
                       const std::string& path, Reader& reader);

}  // namespace flexura
