#pragma once

#include <string_view>

namespace flexura {

/// Returns the version of the library, which is the version of the CMake project.
[[nodiscard]] std::string_view version();

}  // namespace flexura
