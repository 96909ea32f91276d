#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace flexura {

/// Returns the bytes as a gzip file (RFC 1952). The file contains no name and no date, so equal bytes give
/// equal files. Throws std::runtime_error if there is not enough memory.
[[nodiscard]] std::vector<std::uint8_t> gzip(std::string_view bytes);

}  // namespace flexura
