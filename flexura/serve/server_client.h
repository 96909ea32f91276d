#pragma once

#include <memory>

#include "flexura/serve/outbox.h"
#include "flexura/serve/server_loop.h"

namespace flexura {

/// A WebSocket connection.
class Server::Loop::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Loop& loop, ClientId id, tcp::socket socket);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void accept(const Upgrade& how);
  /// Sends waiting messages, unless one is being sent.
  void write();
  /// Closes the connection immediately, so that pending operations fail.
  void cut_off();

  Outbox outbox;  // This and the next member are guarded by the loop's mutex.
  bool overflowed = false;

 private:
  struct Stream;  // Stream of the library Beast.

  void begin();
  /// Reads the next message, if the client has read enough of the messages sent to it.
  void read();
  void heard(const ErrorCode& error);
  void wrote(const ErrorCode& error);
  /// Closes the connection with a status code of the WebSocket protocol.
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
