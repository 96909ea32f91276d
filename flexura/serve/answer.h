#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace flexura {

/// An HTTP answer as it goes out: `head`, then `body` or `fixed`.
struct Answer {
  std::string head;  ///< With the empty line.
  std::string body;
  std::span<const std::uint8_t> fixed;  ///< Lives as long as the program.
  bool last = false;                    ///< The connection ends with it.
};

/// What differs between the heads of answers.
struct AnswerHead {
  int status = 200;
  std::string_view content_type;  ///< None when empty; no body then.
  std::size_t length = 0;
  std::string_view policy;  ///< The page's own when empty.
  std::string_view cache = "no-store";
  std::string_view more;  ///< Further whole lines, each with its CRLF.
  bool last = false;
};

/// The text of a head. All answers forbid what a page of this server does not need (docs/viewer-protocol.md).
std::string format_head(const AnswerHead& head);

/// An answer that says what is wrong in a line; `more` as in AnswerHead.
Answer refusal(int status, std::string_view more, bool last);

/// "Not Found" of 404; "Answer" of what has no name here.
std::string_view reason_phrase(int status);

}  // namespace flexura
