#pragma once

#include <memory>

#include "flexura/serve/outbox.h"
#include "flexura/serve/server_loop.h"

namespace flexura {

/// A connection that speaks WebSocket.
class Server::Loop::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Loop& loop, ClientId id, tcp::socket socket);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void accept(const Upgrade& how);
  /// Sends what waits, unless something is being sent.
  void write();
  /// Ends it without a word; what is going on then fails.
  void cut_off();

  Outbox outbox;  // Guarded by the loop's mutex, as is the next.
  bool overflowed = false;

 private:
  struct Stream;  // Beast's.

  void begin();
  /// Hears the next message, as soon as the client has read enough of what it was sent.
  void read();
  void heard(const ErrorCode& error);
  void wrote(const ErrorCode& error);
  /// With one of WebSocket's codes.
  void close(int code);
  void end();

  Loop* loop_;
  ClientId id_;
  std::unique_ptr<Stream> stream_;
  Outbox::Message sending_;
  bool open_ = false;
  bool reading_ = false;
  bool writing_ = false;
  bool closing_ = false;
};

}  // namespace flexura
