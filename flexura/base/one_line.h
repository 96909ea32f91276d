#pragma once

#include <string>
#include <string_view>

namespace flexura {

/// The text as a message shows it: control characters, ends of lines and bytes that are no UTF-8 as "\n",
/// "\t", "\r" or "\x1b", so that it stays on its line and moves no terminal. All else is left as it is.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace flexura
