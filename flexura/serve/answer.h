#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace flexura {

/// An outgoing HTTP response: `head`, followed by `body` or `fixed`.
struct Answer {
  std::string head;  ///< Status line and header lines, with the empty line at the end.
  std::string body;
  std::span<const std::uint8_t> fixed;  ///< Body in static storage.
  bool last = false;                    ///< Whether the server closes the connection after this answer.
};

/// Variable parts of an answer's head.
struct AnswerHead {
  int status = 200;
  std::string_view content_type;  ///< Media type of the body; if empty, the answer has no body.
  std::size_t length = 0;
  std::string_view policy;  ///< Content security policy; if empty, the policy of the page.
  std::string_view cache = "no-store";
  std::string_view more;  ///< Additional header lines, each with its CRLF.
  bool last = false;
};

/// Returns the text of a head. The security headers in the head forbid everything that the server's pages do
/// not need (docs/viewer-protocol.md).
std::string format_head(const AnswerHead& head);

/// Returns an answer that refuses a request, with the reason phrase of `status` as body. `more` and `last`
/// are as in AnswerHead.
Answer refusal(int status, std::string_view more, bool last);

/// Returns the reason phrase of a status, such as "Not Found" for 404; "Answer" for a status without a
/// phrase.
std::string_view reason_phrase(int status);

}  // namespace flexura
