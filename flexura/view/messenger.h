#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "flexura/serve/server.h"

namespace flexura {

/// Interface for sending messages to clients, implemented by a server or by a replacement in a test. All
/// methods can be called from any thread.
class Messenger {
 public:
  virtual ~Messenger() = default;
  Messenger() = default;
  Messenger(const Messenger&) = delete;
  Messenger& operator=(const Messenger&) = delete;

  /// These functions do the same as Server::send, Server::post and Server::has_room.
  virtual void send(ClientId client, std::string text) = 0;
  virtual void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message) = 0;
  [[nodiscard]] virtual bool has_room(ClientId /*client*/) const { return true; }
};

}  // namespace flexura
