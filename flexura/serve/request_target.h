#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flexura {

/// What a request asks for, decoded.
struct RequestTarget {
  std::string path;  ///< From its first "/"; no "." and ".." among its parts, no control characters.
  std::vector<std::pair<std::string, std::string>>
      query;  ///< In its order; a key without "=" has an empty value.

  /// The value of a key's first mention; null without.
  [[nodiscard]] const std::string* find(std::string_view key) const;
};

/// "/image/front.png?time=1.5" in its parts; nothing when it does not begin with "/", a "%" is not followed
/// by two hexadecimal digits, or the path holds "." or ".." (in any spelling), a backslash or a control
/// character.
std::optional<RequestTarget> parse_request_target(std::string_view text);

}  // namespace flexura
