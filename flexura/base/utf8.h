#pragma once

#include <cstddef>
#include <string_view>

namespace flexura {

/// Returns whether a text is valid UTF-8 (RFC 3629): no overlong forms, no surrogates, no characters beyond
/// U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

/// Returns the number of bytes at the beginning of the text that form complete UTF-8 characters.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

}  // namespace flexura
