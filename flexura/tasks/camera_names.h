#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"

namespace flexura {

/// Returns the indices among `cameras` of the two that a task names, or of the first two if it names none.
/// Requires checked names.
[[nodiscard]] std::array<std::size_t, 2> two_cameras(const std::vector<std::string>& names,
                                                     const std::vector<CameraConfig>& cameras);

/// Reports why the task at `path` does not have two cameras.
void check_two_cameras(const std::vector<std::string>& names, const std::vector<CameraConfig>& cameras,
                       const std::string& path, Reader& reader);

}  // namespace flexura
