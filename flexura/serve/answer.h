#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace flexura {

/// An outgoing HTTP answer: `head`, then `body` or `fixed`.
struct Answer {
  std::string head;  ///< With the empty line.
  std::string body;
  std::span<const std::uint8_t> fixed;  ///< Valid as long as the program.
  bool last = false;                    ///< The connection ends after it.
};

/// Variable parts of an answer's head.
struct AnswerHead {
  int status = 200;
  std::string_view content_type;  ///< If empty, the answer has no type and no body.
  std::size_t length = 0;
  std::string_view policy;  ///< If empty, the page's policy.
  std::string_view cache = "no-store";
  std::string_view more;  ///< Additional whole lines, each with its CRLF.
  bool last = false;
};

/// Returns the text of a head. All answers forbid what a page of this server does not need
/// (docs/viewer-protocol.md).
std::string format_head(const AnswerHead& head);

/// Returns an answer with the reason in one line; `more` as in AnswerHead.
Answer refusal(int status, std::string_view more, bool last);

/// Returns "Not Found" for 404, and "Answer" for a status without a phrase here.
std::string_view reason_phrase(int status);

}  // namespace flexura
