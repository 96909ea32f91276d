#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "flexura/serve/answer.h"
#include "flexura/serve/gate.h"
#include "flexura/serve/request_head.h"
#include "flexura/serve/server.h"

namespace flexura {

/// What all connections of a server share.
struct Site {
  Gate gate;
  std::span<const Asset> assets;
  std::size_t longest_header = std::size_t{16} * 1024;
};

/// What a connection is to do next.
struct ReadMore {};
/// Ask the host, then give its answer to HttpSession::format.
struct Question {
  std::string target;
};
/// Go on as a WebSocket; HttpSession::refuse when it cannot be.
struct Upgrade {
  std::string key;  ///< The client's Sec-WebSocket-Key.
};
using Step = std::variant<ReadMore, Answer, Question, Upgrade>;

/// One HTTP connection without its socket: bytes go in, what to do next comes out. Requests that came
/// together are answered one after the other.
class HttpSession {
 public:
  /// `local`: the address at which the connection came in, without its port.
  HttpSession(const Site& site, std::string local);

  /// Takes what the client sent; at most a header's length more before next() asks for it.
  void feed(std::string_view bytes);
  /// ReadMore until a request is there. After a Question or an Upgrade comes format or refuse; after an
  /// Answer that is the last, nothing.
  Step next();
  /// The host's answer to the last Question.
  [[nodiscard]] Answer format(HttpAnswer host) const;
  /// To an Upgrade that cannot be.
  [[nodiscard]] Answer refuse(int status) const;
  /// Whether a request has begun to come.
  [[nodiscard]] bool begun() const { return !buffer_.empty(); }
  /// The bytes it holds.
  [[nodiscard]] std::size_t held() const { return buffer_.size(); }

 private:
  /// 0 or the status of a refusal; without a `head` then, more is to be read.
  int read_head(std::optional<RequestHead>* head);
  [[nodiscard]] Step decide(const RequestHead& head) const;
  [[nodiscard]] Step secret(const RequestHead& head, std::string_view path) const;
  [[nodiscard]] Step upgrade(const RequestHead& head) const;
  [[nodiscard]] Answer page(const Asset& asset) const;

  const Site* site_;
  std::string local_;
  std::string buffer_;
  std::size_t looked_ = 0;  // So far into buffer_ there is no end of a head.
  bool last_ = false;       // The request being answered is the last.
  std::string cookie_;      // A line for the head of its answer: it showed the token in its header.
};

}  // namespace flexura
