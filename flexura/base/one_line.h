#pragma once

#include <string>
#include <string_view>

namespace flexura {

/// Returns the text in one line for use in a message. Control characters, ends of lines and bytes that are
/// not UTF-8 become "\n", "\t", "\r" or a hexadecimal code such as "\x1b". All other characters remain
/// unchanged.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace flexura
