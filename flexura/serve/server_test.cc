#include "flexura/serve/server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "flexura/serve/own_address.h"
#include "tests/support/raw_client.h"
#include "tests/support/test_host.h"

namespace flexura {
namespace {

using std::chrono::milliseconds;

constexpr std::array<std::uint8_t, 5> zipped_page = {0x1f, 0x8b, 'p', 'a', 'g'};
constexpr std::array<std::uint8_t, 4> script_bytes = {0x1f, 0x8b, 'j', 's'};
constexpr std::array<Asset, 2> page_assets = {
    Asset{"/index.html", "text/html; charset=utf-8", zipped_page},
    Asset{"/assets/index-1a2b.js", "text/javascript", script_bytes}};

class ServerTest : public testing::Test {
 protected:
  Server& start(ServerConfig config = {}) {
    server_ = std::make_unique<Server>(std::move(config), page_assets, host_);
    return *server_;
  }
  [[nodiscard]] std::string host_line() const {
    return "Host: 127.0.0.1:" + std::to_string(server_->port()) + "\r\n";
  }
  [[nodiscard]] std::string bearer() const { return "Authorization: Bearer " + server_->token() + "\r\n"; }
  [[nodiscard]] std::string get(const std::string& target, const std::string& more = {}) const {
    return "GET " + target + " HTTP/1.1\r\n" + host_line() + more + "\r\n";
  }
  [[nodiscard]] std::string upgrade(const std::string& more) const {
    return get("/socket",
               "Connection: keep-alive, Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   more);
  }
  [[nodiscard]] RawAnswer ask(const std::string& request) const {
    RawClient client(server_->port());
    client.send(request);
    return client.read_answer();
  }
  /// Returns a client with access.
  [[nodiscard]] RawClient connected(int receive_buffer = 0) const {
    RawClient client(server_->port(), receive_buffer);
    client.send(upgrade(bearer()));
    if (client.read_answer().status != 101) throw std::runtime_error("no WebSocket");
    return client;
  }

  TestHost host_;
  std::unique_ptr<Server> server_;
};

TEST_F(ServerTest, ServesThePageAndItsParts) {
  start();
  const RawAnswer page = ask(get("/"));
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, std::string(zipped_page.begin(), zipped_page.end()));
  EXPECT_EQ(page.fields.at("content-encoding"), "gzip");
  EXPECT_EQ(page.fields.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(ask(get("/assets/index-1a2b.js")).body, std::string(script_bytes.begin(), script_bytes.end()));
  EXPECT_EQ(ask(get("/assets/other.js")).status, 404);
}

TEST_F(ServerTest, SpeaksWithAClientThatShowsTheToken) {
  Server& server = start();
  RawClient client(server.port());
  client.send(upgrade("Cookie: other=1; flexura_8421=" + server.token() + "\r\n"));
  const RawAnswer hello = client.read_answer();
  ASSERT_EQ(hello.status, 101);
  EXPECT_EQ(hello.fields.at("sec-websocket-accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_FALSE(hello.fields.contains("sec-websocket-extensions"));
  ASSERT_TRUE(host_.wait_for("opened 1"));
  server.send(1, "good day");
  EXPECT_EQ(client.read_frame().payload, "good day");
  server.post(1, 7, std::make_shared<const std::string>("\x01\x02"));
  const RawFrame bytes = client.read_frame();
  EXPECT_EQ(bytes.opcode, 2);
  EXPECT_EQ(bytes.payload, "\x01\x02");
  client.send_text("halt");
  EXPECT_TRUE(host_.wait_for("1 said halt"));
  client.send_frame(0x88, "\x03\xe8");
  EXPECT_EQ(client.read_frame().close_code(), 1000);
  client.end_sending();
  EXPECT_TRUE(host_.wait_for("closed 1"));
}

TEST_F(ServerTest, ListensWhereItSaysAndNowhereElse) {
  Server& server = start();
  EXPECT_GT(server.port(), 0);
  EXPECT_EQ(server.url(), "http://127.0.0.1:" + std::to_string(server.port()) + "/#token=" + server.token());
  // Of all addresses of this machine in 127.0.0.0/8, only this one.
  EXPECT_NO_THROW(RawClient(server.port()));
  EXPECT_THROW(RawClient(server.port(), 0, "127.0.0.2"), std::runtime_error);
  ServerConfig anywhere;
  anywhere.address = "0.0.0.0";
  const Server open_server(anywhere, page_assets, host_);
  EXPECT_NO_THROW(RawClient(open_server.port(), 0, "127.0.0.2"));
  ServerConfig taken;
  taken.port = server.port();
  EXPECT_THROW(Server(taken, page_assets, host_), std::system_error);
  ServerConfig nonsense;
  nonsense.address = "nowhere";
  EXPECT_THROW(Server(nonsense, page_assets, host_), std::system_error);
  // 192.0.2.1 is reserved (RFC 5737).
  ServerConfig foreign;
  foreign.address = "192.0.2.1";
  EXPECT_THROW(Server(foreign, page_assets, host_), std::system_error);
}

TEST_F(ServerTest, HasAnotherTokenEachTime) {
  const std::string first = start().token();
  EXPECT_NE(start().token(), first);
}

TEST_F(ServerTest, IsCalledLocalhostWhereItListensOnAllInterfaces) {
  ServerConfig everywhere;
  everywhere.address = "0.0.0.0";
  const std::string port = std::to_string(start(std::move(everywhere)).port());
  const auto status = [&](const std::string& host) {
    std::string request = "GET / HTTP/1.1\r\nHost: ";
    request += host;
    request += ':';
    request += port;
    request += "\r\n\r\n";
    return ask(request).status;
  };
  EXPECT_EQ(status("localhost"), 200);
  EXPECT_EQ(status("127.0.0.1"), 200);
  EXPECT_EQ(status("evil.example"), 421);
  const std::string outward = outward_address(own_addresses(), false);
  EXPECT_TRUE(server_->url().starts_with("http://" + outward + ":" + port)) << server_->url();
  // The server must accept this address as its name.
  RawClient there(server_->port(), 0, outward.c_str());
  there.send("GET / HTTP/1.1\r\nHost: " + outward + ":" + port + "\r\n\r\n");
  EXPECT_EQ(there.read_answer().status, 200);
}

TEST_F(ServerTest, RefusesThoseWhoDoNotBelongHere) {
  start();
  const std::string wrong = "Authorization: Bearer 00000000000000000000000000000000\r\n";
  EXPECT_EQ(ask("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n").status, 421);
  EXPECT_EQ(ask(upgrade(bearer() + "Origin: http://evil.example\r\n")).status, 403);
  EXPECT_EQ(ask(upgrade("")).status, 401);
  EXPECT_EQ(ask(upgrade(wrong)).status, 401);
  EXPECT_EQ(ask(get("/series", wrong)).status, 401);
  EXPECT_EQ(ask(get("/series", "Sec-Fetch-Site: cross-site\r\n" + bearer())).status, 403);
  EXPECT_EQ(ask("DELETE /series HTTP/1.1\r\n" + host_line() + bearer() + "\r\n").status, 405);
  EXPECT_EQ(ask(get("/../../etc/passwd", bearer())).status, 400);
  EXPECT_EQ(ask(get("/", "X: " + std::string(20000, 'x') + "\r\n")).status, 431);
  EXPECT_EQ(ask(get("/series", "Content-Length: 1\r\n" + bearer())).status, 413);
  EXPECT_TRUE(host_.lines().empty());
}

TEST_F(ServerTest, TakesWhatIsJustWithinItsLimits) {
  start();
  constexpr std::size_t header = 16384;  // From docs/viewer-protocol.md.
  const std::size_t rest = get("/", "X: \r\n").size();
  EXPECT_EQ(ask(get("/", "X: " + std::string(header - rest, 'x') + "\r\n")).status, 200);
  EXPECT_EQ(ask(get("/", "X: " + std::string(header - rest + 1, 'x') + "\r\n")).status, 431);
}

TEST_F(ServerTest, LetsARefusedClientReadWhy) {
  start();
  RawClient client(server_->port());
  // The refusal is sent while the client is still sending: it must not be lost.
  client.send("POST /series HTTP/1.1\r\n" + host_line() + "Content-Length: 1000000\r\n\r\n");
  client.send(std::string(1000000, 'b'));
  EXPECT_EQ(client.read_answer().status, 413);
}

TEST_F(ServerTest, AnswersRequestsThatComeTogether) {
  start();
  RawClient client(server_->port());
  client.send(get("/") + get("/a?b=%20", bearer()) + get("/nothing") +
              get("/assets/index-1a2b.js", "Connection: close\r\n"));
  EXPECT_EQ(client.read_answer().status, 200);
  EXPECT_EQ(client.read_answer().body, "/a?b=%20");
  EXPECT_EQ(client.read_answer().status, 401);
  EXPECT_EQ(client.read_answer().fields.at("connection"), "close");
  EXPECT_EQ(client.read_to_end(), "");
}

TEST_F(ServerTest, EndsClientsThatBreakTheRulesWithTheReason) {
  start();
  const std::string most(std::size_t{64} * 1024, 'm');
  RawClient decent = connected();
  EXPECT_TRUE(decent.send_text(most));
  EXPECT_TRUE(host_.wait_for("1 said " + most));
  RawClient loud = connected();
  loud.send_text(most + "x");
  EXPECT_EQ(loud.read_frame().close_code(), 1009);
  RawClient piecewise = connected();
  piecewise.send_frame(0x01, most);
  piecewise.send_frame(0x80, "x");
  EXPECT_EQ(piecewise.read_frame().close_code(), 1009);
  RawClient binary = connected();
  binary.send_frame(0x82, "bytes");
  EXPECT_EQ(binary.read_frame().close_code(), 1003);
  RawClient garbled = connected();
  garbled.send_text("\xff\xfe");
  EXPECT_EQ(garbled.read_frame().close_code(), 1007);
  RawClient halved = connected();
  halved.send_frame(0x01, "\xf0\x9f");
  halved.send_frame(0x80, "");
  EXPECT_EQ(halved.read_frame().close_code(), 1007);
  RawClient bare = connected();
  bare.send("\x81\x02hi");  // Not masked.
  EXPECT_EQ(bare.read_frame().close_code(), 1002);
  RawClient compressed = connected();
  compressed.send_frame(0xC1, "x");  // Claims permessage-deflate, which was not negotiated.
  EXPECT_EQ(compressed.read_frame().close_code(), 1002);
  const auto lines = host_.lines();
  EXPECT_EQ(std::ranges::count_if(lines, [](const auto& line) { return line.find(" said ") != line.npos; }),
            1);
}

TEST_F(ServerTest, HasRoomForSoManyClients) {
  start();
  std::list<RawClient> clients;
  for (int i = 0; i < 8; ++i) clients.push_back(connected());
  EXPECT_EQ(ask(upgrade(bearer())).status, 503);
  clients.pop_front();
  ASSERT_TRUE(host_.wait_for("closed 1"));
  EXPECT_EQ(ask(upgrade(bearer())).status, 101);
}

TEST_F(ServerTest, HasRoomForSoManyWhoSayNothingYet) {
  ServerConfig config;
  config.handshake = milliseconds(2000);
  Server& server = start(config);
  RawClient client = connected();
  ASSERT_TRUE(host_.wait_for("opened 1"));
  constexpr int most_visits = 64;
  std::list<RawClient> visitors;
  for (int i = 0; i < most_visits; ++i) visitors.emplace_back(server.port());
  // One more takes the place of the oldest, whose time has not expired. Connected clients are unaffected.
  RawClient newcomer(server.port());
  newcomer.send(get("/"));
  EXPECT_EQ(newcomer.read_answer().status, 200);
  EXPECT_EQ(visitors.front().read_to_end(), "");
  visitors.pop_front();
  visitors.front().send(get("/"));
  EXPECT_EQ(visitors.front().read_answer().status, 200);
  server.send(1, "good day");
  EXPECT_EQ(client.read_frame().payload, "good day");
  visitors.back().read_to_end();
  EXPECT_EQ(ask(get("/")).status, 200);
}

// 150 connections send a byte, are ended, and connect again, as fast as they can.
TEST_F(ServerTest, HearsNewcomersThroughAFloodOfConnections) {
  const Server& server = start();
  std::atomic<bool> goes_on = true;
  std::atomic<long> connected = 0;
  std::vector<std::thread> flood;
  for (int i = 0; i < 3; ++i)
    flood.emplace_back([&] {
      std::deque<RawClient> held;
      while (goes_on) {
        held.emplace_back(server.port());
        (void)held.back().send("G");
        ++connected;
        if (held.size() > 50) held.pop_front();
      }
    });
  while (connected < 500) std::this_thread::yield();
  // A newcomer may itself be ended before it is heard, and then tries again.
  const auto is_heard = [&] {
    constexpr int most_tries = 200;
    for (int i = 0; i < most_tries; ++i) {
      RawClient newcomer(server.port());
      if (newcomer.send(get("/", "Connection: close\r\n")) &&
          newcomer.read_to_end().find(" 200 ") != std::string::npos)
        return true;
    }
    return false;
  };
  EXPECT_TRUE(is_heard());
  goes_on = false;
  for (std::thread& one : flood) one.join();
}

TEST(ServerConfig, GivesAHandshakeFiveSecondsAndSilenceTwenty) {
  EXPECT_EQ(ServerConfig{}.handshake, std::chrono::seconds(5));
  EXPECT_EQ(ServerConfig{}.idle, std::chrono::seconds(20));
}

TEST_F(ServerTest, DoesNotWaitForHandshakes) {
  ServerConfig config;
  config.handshake = milliseconds(300);
  start(config);
  RawClient silent(server_->port());
  RawClient half(server_->port());
  half.send("GET / HTTP/1.1\r\nHost");
  RawClient dripping(server_->port());
  bool taken = true;
  for (int i = 0; i < 2000 && taken; ++i) {  // Each byte arrives in time, the whole request does not.
    taken = dripping.send("x");
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_FALSE(taken);
  for (RawClient* client : {&silent, &half}) EXPECT_EQ(client->read_to_end(), "");
}

TEST_F(ServerTest, EndsConnectionsWithoutALifeSign) {
  ServerConfig config;
  config.idle = milliseconds(1500);
  start(config);
  RawClient lively = connected();
  RawClient dead = connected();
  for (int i = 0; i < 3; ++i) {
    const RawFrame ping = lively.read_frame();
    ASSERT_EQ(ping.opcode, 9);
    lively.send_frame(0x8A, ping.payload);
  }
  EXPECT_TRUE(host_.wait_for("closed 2"));
  lively.send_text("here");
  EXPECT_TRUE(host_.wait_for("1 said here"));
  RawClient pausing(server_->port());
  pausing.send(get("/"));
  EXPECT_EQ(pausing.read_answer().status, 200);
  EXPECT_EQ(pausing.read_to_end(), "");
}

TEST_F(ServerTest, CutsOffAClientThatDoesNotReadItsTexts) {
  Server& server = start();
  RawClient deaf = connected(4096);
  ASSERT_TRUE(host_.wait_for("opened 1"));
  const std::string text(10000, 't');
  std::size_t most = 0;
  for (int i = 0; i < 1000; ++i) {
    server.send(1, text);
    most = std::max(most, server.waiting_bytes());
  }
  EXPECT_TRUE(host_.wait_for("closed 1"));
  EXPECT_LE(most, ServerConfig{}.waiting_bytes + 2 * text.size());
  EXPECT_EQ(server.waiting_bytes(), 0U);
}

TEST_F(ServerTest, ForgetsWhatIsForNobody) {
  Server& server = start();
  server.send(7, "text");
  server.post(7, 1, std::make_shared<const std::string>("bytes"));
  EXPECT_EQ(server.waiting_bytes(), 0U);
}

}  // namespace
}  // namespace flexura
