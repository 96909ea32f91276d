#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flexura {

/// Decoded target of a request.
struct RequestTarget {
  std::string
      path;  ///< Path that begins with "/". The path has no parts "." or "..", and no control characters.
  std::vector<std::pair<std::string, std::string>>
      query;  ///< Keys and values in the order of the query; a key without "=" has an empty value.

  /// Returns the value of a key's first occurrence; null if missing.
  [[nodiscard]] const std::string* find(std::string_view key) const;
};

/// Splits "/image/front.png?time=1.5" into its parts. Returns std::nullopt if the text does not begin with
/// "/", or a "%" is not followed by two hexadecimal digits. Also returns std::nullopt if the path contains a
/// part "." or ".." (in any encoding), a backslash or a control character.
std::optional<RequestTarget> parse_request_target(std::string_view text);

}  // namespace flexura
