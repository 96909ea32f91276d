#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "flexura/serve/server_loop.h"

namespace flexura {

/// An HTTP connection: executes the steps of HttpSession within the time limits.
class Server::Loop::Visit : public std::enable_shared_from_this<Visit> {
 public:
  Visit(Loop& loop, tcp::socket socket);

  void start() {
    deadline(loop_->config_.handshake);
    advance();
  }
  void close();
  void end();
  /// Number of the visit; later visits have larger numbers.
  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] bool has_shown_token() const { return session_.has_shown_token(); }
  void answer(Answer answer);
  /// Sends the host's answer to the last question.
  void answer(HttpAnswer host) { answer(session_.format(std::move(host))); }

 private:
  void advance();
  void read();
  void came(std::size_t count);
  void rest();
  void linger();
  void read_over();
  void ask(std::string target);
  void upgrade(const Upgrade& how);
  void deadline(std::chrono::milliseconds limit);

  Loop* loop_;
  std::uint64_t number_;
  HttpSession session_;
  tcp::socket socket_;
  net::steady_timer timer_;
  std::array<char, 16384> bytes_{};
  Answer answer_;
  bool begun_ =
      true;  // Whether the deadline is for a request; otherwise it is for the pause between requests.
};

}  // namespace flexura
