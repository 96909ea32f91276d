#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace flexura {

/// The head of an HTTP/1 request.
struct RequestHead {
  struct Field {
    std::string name;  ///< In lower case.
    std::string value;
  };

  std::string method;
  std::string target;  ///< Target as received, not decoded.
  int minor = 1;       ///< Minor version of HTTP/1.
  std::vector<Field> fields;
  bool keep_alive = false;  ///< Whether the client wants to keep the connection.

  /// Returns the value of a field, by its name in lower case; null if missing. Fields that affect decisions
  /// occur at most once.
  [[nodiscard]] const std::string* find(std::string_view name) const;
  /// Returns true if the field `name`, a list of tokens, contains `token`. Both arguments must be in lower
  /// case.
  [[nodiscard]] bool lists(std::string_view name, std::string_view token) const;
};

/// HTTP status for an invalid head.
struct Refusal {
  int status = 400;
};

/// Parses a head, from its first line to its last CRLF, without the empty line. Refuses all ambiguous syntax
/// that RFC 9112 permits a server to refuse. Examples of refused syntax are bare line feeds, folded lines,
/// blanks around a field's name, a repeated length, and two Host fields. A request with a body, of any length
/// or encoding, is refused with status 413.
std::variant<RequestHead, Refusal> parse_request_head(std::string_view text);

/// Returns the text with ASCII letters in lower case, independent of the locale.
std::string in_lower_case(std::string_view text);
/// Returns the text without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace flexura
