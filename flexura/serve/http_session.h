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

/// Next action of a connection: read more bytes.
struct ReadMore {};
/// Next action of a connection: ask the host, then pass its answer to HttpSession::format.
struct Question {
  std::string target;
};
/// Next action of a connection: continue as a WebSocket. If a WebSocket is impossible, call
/// HttpSession::refuse.
struct Upgrade {
  std::string key;  ///< Client's Sec-WebSocket-Key.
};
using Step = std::variant<ReadMore, Answer, Question, Upgrade>;

/// The protocol of one HTTP connection, without a socket. An HttpSession receives bytes and returns actions.
/// Requests that arrive together are answered one after another.
class HttpSession {
 public:
  /// `local`: the local address of the connection, without its port.
  HttpSession(const Site& site, std::string local);

  /// Adds bytes from the client. Before next() returns ReadMore again, at most `longest_header` bytes may be
  /// added.
  void feed(std::string_view bytes);
  /// Returns the next action: Returns the next action, which is ReadMore until a request is complete. The
  /// caller must call format() after a Question, and refuse() after an Upgrade that fails. After an Answer
  /// with `last`, the caller must not call any more functions.
  Step next();
  /// Returns the HTTP response with the host's answer to the last Question.
  [[nodiscard]] Answer format(HttpAnswer host) const;
  /// Returns the HTTP response for an Upgrade that is impossible.
  [[nodiscard]] Answer refuse(int status) const;
  /// Returns true if a request has begun to arrive.
  [[nodiscard]] bool begun() const { return !buffer_.empty(); }
  /// Returns true if a request had the token.
  [[nodiscard]] bool has_shown_token() const { return has_shown_token_; }
  /// Returns the number of bytes in the buffer.
  [[nodiscard]] std::size_t held() const { return buffer_.size(); }

 private:
  /// Reads the head of the next request. Returns 0, or the status with which to refuse the request. If the
  /// result is 0 and `head` is empty, more bytes are needed.
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
  bool has_shown_token_ = false;
  std::string
      cookie_;  // Header line that sets the cookie in the answer, if the request had the token in its header.
};

}  // namespace flexura
