#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flexura {

/// Decoded target of a request.
struct RequestTarget {
  std::string path;  ///< From its first "/"; without "." and ".." as parts, without control characters.
  std::vector<std::pair<std::string, std::string>>
      query;  ///< In its order; a key without "=" has an empty value.

  /// Returns the value of a key's first occurrence; null if missing.
  [[nodiscard]] const std::string* find(std::string_view key) const;
};

/// Splits "/image/front.png?time=1.5" into its parts. Returns std::nullopt if it does not begin with "/" or a
/// "%" is not followed by two hexadecimal digits. Also if the path contains "." or ".." (in any spelling), a
/// backslash or a control character.
std::optional<RequestTarget> parse_request_target(std::string_view text);

}  // namespace flexura
