#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"

namespace flexura {

/// Returns the indices in `cameras` of the two cameras that a task names. A task without names uses the first
/// two cameras. Requires checked names.
[[nodiscard]] std::array<std::size_t, 2> two_cameras(const std::vector<std::string>& names,
                                                     const std::vector<CameraConfig>& cameras);

/// Reports an error if the task at `path` cannot use two cameras.
void check_two_cameras(const std::vector<std::string>& names, const std::vector<CameraConfig>& cameras,
                       const std::string& path, Reader& reader);

}  // namespace flexura
