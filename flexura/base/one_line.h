#pragma once

#include <string>
#include <string_view>

namespace flexura {

/// Returns the text for use in a message, on one line and without terminal control. Control characters, ends
/// of lines and bytes that are not UTF-8 become "
/// ", "\t", "\r" or "\x1b". All else is unchanged.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace flexura
