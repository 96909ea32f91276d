#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace flexura {

/// The bytes as a gzip file (RFC 1952), without a name or a date: the same bytes give the same file.
/// std::runtime_error when there is no memory for it.
[[nodiscard]] std::vector<std::uint8_t> gzip(std::string_view bytes);

}  // namespace flexura
