#pragma once

#include <string_view>

namespace flexura {

/// The version of the library, of the CMake project.
[[nodiscard]] std::string_view version();

}  // namespace flexura
