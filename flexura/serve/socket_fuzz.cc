// Any bytes from a client with access, through a real server and socket. The server must pass each whole text
// to its host, in UTF-8 and within the limit. It must answer in whole frames, and release the client after it
// has disconnected.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "flexura/base/utf8.h"
#include "flexura/serve/server.h"
#include "tests/support/raw_client.h"

namespace {

using flexura::ClientId;

void require(bool holds) {
  if (!holds) std::abort();
}

constexpr std::size_t longest = 1000;

/// Returns received texts.
class Echo : public flexura::Host {
 public:
  void opened(ClientId client) override {
    require(inside_ == 0);
    inside_ = client;
  }
  void closed(ClientId client) override {
    require(inside_ == client);
    inside_ = 0;
  }
  void on_message(ClientId client, std::string text) override {
    require(inside_ == client && text.size() <= longest && flexura::is_utf8(text));
    server->post(client, 1, std::make_shared<const std::string>(text));
    server->send(client, std::move(text));
  }
  void asked(std::string, std::function<void(flexura::HttpAnswer)>) override { std::abort(); }

  flexura::Server* server = nullptr;

 private:
  ClientId inside_ = 0;  // One client at a time.
};

/// One server for all inputs: one per input would measure the start of threads.
struct Running {
  Running() {
    flexura::ServerConfig config;
    config.longest_message = longest;
    server = std::make_unique<flexura::Server>(config, std::span<const flexura::Asset>{}, echo);
    echo.server = server.get();
  }
  Echo echo;
  std::unique_ptr<flexura::Server> server;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Running running;
  flexura::RawClient client(running.server->port());
  client.send("GET /socket HTTP/1.1\r\nHost: localhost:" + std::to_string(running.server->port()) +
              "\r\nAuthorization: Bearer " + running.server->token() +
              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  require(client.read_answer().status == 101);
  client.send({reinterpret_cast<const char*>(data), size});
  client.end_sending();
  for (auto frame = client.read_frame(); frame.opcode != 0; frame = client.read_frame()) {
    require(frame.opcode == 1 || frame.opcode == 2 || frame.opcode == 8 || frame.opcode == 10);
    require(frame.opcode > 2 || frame.payload.size() <= longest);
  }
  return 0;
}
