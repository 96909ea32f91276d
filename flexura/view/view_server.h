#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "flexura/serve/server.h"
#include "flexura/view/front_door.h"
#include "flexura/view/messenger.h"

namespace flexura {

/// A viewer with its server. The viewer and the server run as long as this object exists.
class ViewServer {
 public:
  /// Throws std::system_error if the server cannot listen at the configured address.
  ViewServer(ViewStart start, ServerConfig config, std::span<const Asset> assets);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  [[nodiscard]] std::string url() const { return server_.url(); }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] const std::string& token() const { return server_.token(); }
  /// These functions call the functions of Server with the same names.
  [[nodiscard]] std::size_t waiting_bytes() const { return server_.waiting_bytes(); }
  [[nodiscard]] std::size_t busy_clients() const { return server_.busy_clients(); }

 private:
  class ServerMessenger : public Messenger {
   public:
    explicit ServerMessenger(Server& server) : server_(server) {}
    void send(ClientId client, std::string text) override { server_.send(client, std::move(text)); }
    void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message) override {
      server_.post(client, stream, std::move(message));
    }
    [[nodiscard]] bool has_room(ClientId client) const override { return server_.has_room(client); }

   private:
    Server& server_;
  };

  FrontDoor door_;
  Server server_;
  ServerMessenger messenger_;
};

}  // namespace flexura
