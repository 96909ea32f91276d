#include "flexura/serve/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace flexura {

namespace {

// The page loads only its own parts and connects only to its own server; pictures also come from received
// data.
constexpr std::string_view page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
    "'self'; font-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr std::array<std::pair<int, std::string_view>, 17> phrases = {{
    {101, "Switching Protocols"},
    {200, "OK"},
    {204, "No Content"},
    {400, "Bad Request"},
    {401, "Unauthorized"},
    {403, "Forbidden"},
    {404, "Not Found"},
    {405, "Method Not Allowed"},
    {408, "Request Timeout"},
    {409, "Conflict"},
    {413, "Content Too Large"},
    {421, "Misdirected Request"},
    {426, "Upgrade Required"},
    {431, "Request Header Fields Too Large"},
    {500, "Internal Server Error"},
    {503, "Service Unavailable"},
    {505, "HTTP Version Not Supported"},
}};

}  // namespace

std::string_view reason_phrase(int status) {
  const auto* const found = std::ranges::find(phrases, status, &std::pair<int, std::string_view>::first);
  return found == phrases.end() ? "Answer" : found->second;
}

std::string format_head(const AnswerHead& head) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "HTTP/1.1 {} {}\r\n"
                 "Server: flexura\r\n"
                 "Content-Security-Policy: {}\r\n"
                 "X-Content-Type-Options: nosniff\r\n"
                 "X-Frame-Options: DENY\r\n"
                 "Referrer-Policy: no-referrer\r\n"
                 "Cross-Origin-Opener-Policy: same-origin\r\n"
                 "Cross-Origin-Resource-Policy: same-origin\r\n"
                 "Cache-Control: {}\r\n",
                 head.status, reason_phrase(head.status), head.policy.empty() ? page_policy : head.policy,
                 head.cache);
  if (!head.content_type.empty()) fmt::format_to(out, "Content-Type: {}\r\n", head.content_type);
  if (head.status != 204) fmt::format_to(out, "Content-Length: {}\r\n", head.length);
  fmt::format_to(out, "{}Connection: {}\r\n\r\n", head.more, head.last ? "close" : "keep-alive");
  return text;
}

Answer refusal(int status, std::string_view more, bool last) {
  Answer answer;
  answer.body = fmt::format("{} {}\n", status, reason_phrase(status));
  answer.head = format_head({.status = status,
                             .content_type = "text/plain; charset=utf-8",
                             .length = answer.body.size(),
                             .policy = {},
                             .cache = "no-store",
                             .more = more,
                             .last = last});
  answer.last = last;
  return answer;
}

}  // namespace flexura
