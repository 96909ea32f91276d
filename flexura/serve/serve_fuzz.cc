// Any bytes from a client, in pieces of any size. The connection must answer each request once, store a
// limited number of bytes, and give nothing secret to a client without the token. Its answers must not depend
// on the division of the bytes.
//
// The first byte gives the length of the pieces. "%T" stands for the token, so that mutations preserve the
// difference between inputs with and without it.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>

#include "flexura/serve/http_session.h"

namespace {

using flexura::Answer;
using flexura::HttpSession;
using flexura::Step;

constexpr std::string_view token = "00112233445566778899aabbccddeeff";
constexpr std::array<std::uint8_t, 3> bytes = {1, 2, 3};
constexpr std::array<flexura::Asset, 2> assets = {flexura::Asset{"/index.html", "text/html", bytes},
                                                  flexura::Asset{"/assets/a.js", "text/javascript", bytes}};

const flexura::Site& site() {
  static const flexura::Site one{flexura::Gate(8421, {"localhost"}, std::string(token)), assets, 1024};
  return one;
}

void require(bool holds) {
  if (!holds) std::abort();
}

bool ends_connection(const Answer& answer) {
  require(answer.head.starts_with("HTTP/1.1 ") && answer.head.ends_with("\r\n\r\n"));
  require(answer.head.find("\r\n\r\n") == answer.head.size() - 4);
  require(answer.head.find("Content-Security-Policy: default-src 'none'") != std::string::npos);
  require((answer.head.find("Connection: close") != std::string::npos) == answer.last);
  return answer.last;
}

/// Returns all steps of a connection that gets these bytes in pieces; sets `authorised` if one needed the
/// token.
std::string conversation(std::string_view text, std::size_t piece, bool& authorised) {
  HttpSession session(site(), "127.0.0.1");
  std::string reported;
  while (true) {
    const Step step = session.next();
    require(session.held() <= site().longest_header + std::max(piece, text.size()));
    if (const auto* answer = std::get_if<Answer>(&step)) {
      reported += answer->head.substr(9, 4);
      if (ends_connection(*answer)) return reported;
    } else if (const auto* question = std::get_if<flexura::Question>(&step)) {
      require(question->target.starts_with('/') &&
              question->target.find_first_of("\r\n ") == std::string::npos);
      reported += "ask " + question->target;
      authorised = true;
      if (ends_connection(session.format({.status = 200, .content_type = "a/b", .body = "c", .policy = {}})))
        return reported;
    } else if (const auto* upgrade = std::get_if<flexura::Upgrade>(&step)) {
      require(upgrade->key.size() == 24);
      authorised = true;
      return reported + "upgrade";
    } else {
      require(session.held() <= site().longest_header);
      if (text.empty()) return reported + "more";
      session.feed(text.substr(0, piece));
      text.remove_prefix(std::min(piece, text.size()));
    }
  }
}

std::string with_token(std::string_view text) {
  std::string whole;
  for (std::size_t at = text.find("%T"); at != std::string_view::npos; at = text.find("%T")) {
    whole += text.substr(0, at);
    whole += token;
    text.remove_prefix(at + 2);
  }
  return whole += text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string whole = with_token(text);
  bool authorised = false;
  const std::string reported = conversation(whole, std::size_t{data[0]} + 1, authorised);
  const std::string slowly = conversation(whole, 1, authorised);
  // A WebSocket is refused if other bytes arrive with its request.
  const bool socket = reported.ends_with("upgrade") || slowly.ends_with("upgrade");
  require(socket || reported == slowly);
  require(!authorised || whole.find(token) != std::string::npos);
  return 0;
}
