#pragma once

#include <cstddef>
#include <string_view>

namespace flexura {

/// Returns whether a text is valid UTF-8: no overlong forms, no surrogates, nothing beyond U+10FFFF (RFC
/// 3629).
[[nodiscard]] bool is_utf8(std::string_view text);

/// Returns the number of bytes at the beginning that are complete characters of UTF-8.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

}  // namespace flexura
