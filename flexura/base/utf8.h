#pragma once

#include <cstddef>
#include <string_view>

namespace flexura {

/// Whether a text is whole UTF-8: no overlong forms, no surrogates, nothing beyond U+10FFFF (RFC 3629).
[[nodiscard]] bool is_utf8(std::string_view text);

/// How many bytes from the beginning on are whole characters of UTF-8.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

}  // namespace flexura
