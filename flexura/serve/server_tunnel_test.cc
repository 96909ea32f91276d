// A browser at the other end of a tunnel (`ssh -L 9000:127.0.0.1:8421`). The connection is from this machine,
// and Host and Origin have the tunnel's end with its port.
#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/raw_client.h"
#include "tests/support/test_host.h"

namespace flexura {
namespace {

class TunnelTest : public testing::Test {
 protected:
  void start(std::vector<std::string> names) {
    ServerConfig config;
    config.names = std::move(names);
    server_ = std::make_unique<Server>(std::move(config), std::span<const Asset>{}, host_);
    // Different from the server's.
    far_end_ = "localhost:" + std::to_string(server_->port() == 9000 ? 9001 : 9000);
  }
  // Sends a request like a page from `host`.
  [[nodiscard]] RawAnswer ask(const std::string& line, const std::string& host,
                              const std::string& more) const {
    RawClient client(server_->port());
    client.send(line + " HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
                "\r\nSec-Fetch-Site: same-origin\r\n" + more + "\r\n");
    return client.read_answer();
  }
  [[nodiscard]] int come_in(const std::string& host) const {
    return ask("GET /series", host, "Authorization: Bearer " + server_->token() + "\r\n").status;
  }
  // Uses the cookie of the page at that host, named by the port that the page uses.
  [[nodiscard]] int connect(const std::string& host) const {
    return ask("GET /socket", host,
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nCookie: flexura_" +
                   host.substr(host.find(':') + 1) + "=" + server_->token() + "\r\n")
        .status;
  }

  TestHost host_;
  std::unique_ptr<Server> server_;
  std::string far_end_;
};

TEST_F(TunnelTest, OfTheServersOwnPortNeedsNoName) {
  start({});
  for (const char* name : {"localhost:", "127.0.0.1:"}) {
    const std::string host = name + std::to_string(server_->port());
    EXPECT_EQ(come_in(host), 200) << host;
    EXPECT_EQ(connect(host), 101) << host;
  }
}

TEST_F(TunnelTest, OfAnotherPortIsRefusedUntilItIsNamed) {
  start({});
  EXPECT_EQ(come_in(far_end_), 421);
  start({far_end_});
  EXPECT_EQ(come_in(far_end_), 200);
  EXPECT_EQ(connect(far_end_), 101);
  EXPECT_EQ(connect("localhost:9002"), 421) << "a port that nobody named";
  EXPECT_EQ(come_in("127.0.0.1:" + std::to_string(server_->port())), 200) << "its own name holds as before";
}

}  // namespace
}  // namespace flexura
