#pragma once

#include <string_view>

namespace flexura {

/// The version of the library, "0.2.0", from the CMake project.
[[nodiscard]] std::string_view version();

}  // namespace flexura
