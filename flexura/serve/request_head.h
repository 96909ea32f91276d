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
  std::string target;  ///< As it came.
  int minor = 1;       ///< Of HTTP/1.minor.
  std::vector<Field> fields;
  bool keep_alive = false;  ///< Whether the client wants the connection to go on.

  /// The value of a field, by its name in lower case; null without. Of the fields that decide something there
  /// is one at most.
  [[nodiscard]] const std::string* find(std::string_view name) const;
  /// Whether a field that lists tokens has this one; both in lower case.
  [[nodiscard]] bool lists(std::string_view name, std::string_view token) const;
};

/// The HTTP status that says why there is no head.
struct Refusal {
  int status = 400;
};

/// Reads a head, from its first line to its last CRLF, without the empty line. What two readers could
/// understand differently is refused, where RFC 9112 lets a reader choose: bare line feeds, folded lines,
/// blanks around a name, a length said twice, two Hosts. No request here has a body: one of any length or
/// encoding gets 413.
std::variant<RequestHead, Refusal> parse_request_head(std::string_view text);

/// ASCII letters in lower case, whatever the locale.
std::string in_lower_case(std::string_view text);
/// Without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace flexura
