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

/// Shared data of a server's connections.
struct Site {
  Gate gate;
  std::span<const Asset> assets;
  std::size_t longest_header = std::size_t{16} * 1024;
};

/// Next action of a connection.
struct ReadMore {};
/// Ask the host, then pass its answer to HttpSession::format.
struct Question {
  std::string target;
};
/// Continue as a WebSocket. If that is impossible, call HttpSession::refuse.
struct Upgrade {
  std::string key;  ///< Client's Sec-WebSocket-Key.
};
using Step = std::variant<ReadMore, Answer, Question, Upgrade>;

/// One HTTP connection without its socket: bytes are the input, actions the output. Requests that arrive
/// together are answered one after the other.
class HttpSession {
 public:
  /// `local`: the local address of the connection, without its port.
  HttpSession(const Site& site, std::string local);

  /// Adds bytes from the client; at most the length of a header more before next() requests them.
  void feed(std::string_view bytes);
  /// Returns ReadMore until a request is complete. After a Question or an Upgrade, call format or refuse;
  /// after an Answer that is the last, nothing.
  Step next();
  /// Returns the HTTP answer for the host's answer to the last Question.
  [[nodiscard]] Answer format(HttpAnswer host) const;
  /// Returns the answer to an impossible Upgrade.
  [[nodiscard]] Answer refuse(int status) const;
  /// Returns true if a request has begun to arrive.
  [[nodiscard]] bool begun() const { return !buffer_.empty(); }
  /// Returns the number of bytes in the buffer.
  [[nodiscard]] std::size_t held() const { return buffer_.size(); }

 private:
  /// Returns 0 or the status of a refusal; 0 without a `head` means that more bytes are needed.
  int read_head(std::optional<RequestHead>* head);
  [[nodiscard]] Step decide(const RequestHead& head) const;
  [[nodiscard]] Step secret(const RequestHead& head, std::string_view path) const;
  [[nodiscard]] Step upgrade(const RequestHead& head) const;
  [[nodiscard]] Answer page(const Asset& asset) const;

  const Site* site_;
  std::string local_;
  std::string buffer_;
  std::size_t looked_ = 0;  // Position in buffer_ up to which there is no end of a head.
  bool last_ = false;       // The current request is the last.
  std::string cookie_;      // Header line for its answer, if the request had the token in its header.
};

}  // namespace flexura
