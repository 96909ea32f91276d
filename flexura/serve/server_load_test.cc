// A client's behaviour must not affect other clients or senders; many threads at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "flexura/serve/server.h"
#include "tests/support/raw_client.h"
#include "tests/support/test_host.h"

namespace flexura {
namespace {

std::string request(const Server& server, const std::string& target, const std::string& more = {}) {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost:" + std::to_string(server.port()) +
         "\r\nAuthorization: Bearer " + server.token() + "\r\n" + more + "\r\n";
}

RawClient connected(const Server& server, int receive_buffer = 0) {
  RawClient client(server.port(), receive_buffer);
  client.send(request(server, "/socket",
                      "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"));
  EXPECT_EQ(client.read_answer().status, 101);
  return client;
}

/// Returns "number filling" with this number of bytes.
std::shared_ptr<const std::string> numbered(int number, std::size_t size) {
  std::string text = std::to_string(number) + ' ';
  text.resize(size, '.');
  return std::make_shared<const std::string>(std::move(text));
}

constexpr std::uint32_t states = 1;
constexpr std::uint32_t images = 2;
constexpr std::size_t state_size = 2000;
constexpr std::size_t image_size = 40000;

TEST(ServerLoad, FourClientsThatNeverReadChangeNothingForAGoodOne) {
  TestHost host;
  Server server({}, {}, host);
  std::vector<RawClient> deaf;
  deaf.reserve(4);
  for (int i = 0; i < 4; ++i) deaf.push_back(connected(server, 4096));
  RawClient good = connected(server);
  ASSERT_TRUE(host.wait_for("opened 5"));
  std::size_t most = 0;
  // Each round ends when the good client has both messages: it misses none, and the sender never waits for
  // another client.
  for (int round = 0; round < 1000; ++round) {
    const auto state = numbered(round, state_size);
    const auto image = numbered(round, image_size);
    for (ClientId client = 1; client <= 5; ++client) {
      server.post(client, states, state);
      server.post(client, images, image);
    }
    most = std::max(most, server.waiting_bytes());
    ASSERT_EQ(good.read_frame().payload, *state);
    ASSERT_EQ(good.read_frame().payload, *image);
  }
  // Of each stream, at most one message waits and one is being sent.
  EXPECT_LE(most, std::size_t{5} * 2 * (state_size + image_size));
}

TEST(ServerLoad, ASlowClientLosesOldMessagesNeverTheNewest) {
  TestHost host;
  Server server({}, {}, host);
  RawClient slow = connected(server, 4096);
  ASSERT_TRUE(host.wait_for("opened 1"));
  constexpr int last = 2000;
  for (int number = 0; number <= last; ++number) server.post(1, images, numbered(number, image_size));
  int before = -1;
  int received = 0;
  while (before != last) {
    const int number = std::stoi(slow.read_frame().payload);
    ASSERT_GT(number, before);
    before = number;
    ++received;
  }
  EXPECT_LT(received, last / 2);
}

/// A host that keeps the answer functions.
class SlowHost : public TestHost {
 public:
  void asked(std::string target, std::function<void(HttpAnswer)> answer) override {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(std::move(answer));
    }
    TestHost::asked(std::move(target), [](const HttpAnswer&) {});
  }
  std::vector<std::function<void(HttpAnswer)>> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<std::function<void(HttpAnswer)>> waiting_;
};

TEST(ServerLoad, AHostMayAnswerLaterFromAnyThreadOrNever) {
  SlowHost host;
  auto server = std::make_unique<Server>(ServerConfig{}, std::span<const Asset>{}, host);
  RawClient client(server->port());
  client.send(request(*server, "/late") + request(*server, "/never") + request(*server, "/too-late"));
  ASSERT_TRUE(host.wait_for("asked /late"));
  std::thread([answer = host.take().front()] {
    answer({.status = 200, .content_type = "text/plain", .body = "late", .policy = {}});
    answer({.status = 200, .content_type = "text/plain", .body = "twice", .policy = {}});
  }).join();
  EXPECT_EQ(client.read_answer().body, "late");
  ASSERT_TRUE(host.wait_for("asked /never"));
  host.take();
  EXPECT_EQ(client.read_answer().status, 500);
  ASSERT_TRUE(host.wait_for("asked /too-late"));
  server.reset();
  EXPECT_EQ(client.read_to_end(), "");
  for (const auto& answer : host.take())
    answer({.status = 200, .content_type = "a", .body = "b", .policy = {}});
}

TEST(ServerLoad, EndsWithClientsInItAndCallsNothingAfterwards) {
  TestHost host;
  auto server = std::make_unique<Server>(ServerConfig{}, std::span<const Asset>{}, host);
  RawClient client = connected(*server);
  RawClient visitor(server->port());
  ASSERT_TRUE(host.wait_for("opened 1"));
  server.reset();
  const auto lines = host.lines();
  client.send_text("anyone?");
  EXPECT_EQ(client.read_frame().opcode, 0);
  EXPECT_EQ(visitor.read_to_end(), "");
  EXPECT_EQ(host.lines(), lines);
}

// Repeats each received text twice: sends more than it receives.
class EchoingHost : public TestHost {
 public:
  void on_message(ClientId client, std::string text) override {
    ++heard;
    server.load()->send(client, text);
    server.load()->send(client, std::move(text));
  }
  std::atomic<Server*> server = nullptr;
  std::atomic<int> heard = 0;
};

TEST(ServerLoad, CutsNobodyOffWhoReads) {
  EchoingHost host;
  Server server({}, {}, host);
  host.server = &server;
  RawClient client = connected(server);
  constexpr int count = 20000;  // More than all buffers hold.
  std::thread asking([&] {
    for (int i = 0; i < count; ++i) client.send_text(std::to_string(i));
  });
  int i = 0;
  while (i < 2 * count && client.read_frame().payload == std::to_string(i / 2)) ++i;
  EXPECT_EQ(i, 2 * count);
  asking.join();
}

TEST(ServerLoad, ListensToNobodyWhoDoesNotReadAndThenEndsIt) {
  EchoingHost host;
  ServerConfig config;
  config.idle = std::chrono::milliseconds(1000);
  Server server(config, {}, host);
  host.server = &server;
  RawClient deaf = connected(server, 4096);
  const std::string text(10000, 't');
  while (deaf.send_text(text)) {
  }
  EXPECT_TRUE(host.wait_for("closed 1"));
  // A quarter of the limit, plus the system's buffers.
  EXPECT_LE(2 * text.size() * static_cast<std::size_t>(host.heard),
            ServerConfig{}.waiting_bytes / 4 + (std::size_t{1} << 20));
  EXPECT_EQ(server.waiting_bytes(), 0U);
}

TEST(ServerLoad, ManyThreadsMaySendWhileClientsComeAndGo) {
  TestHost host;
  Server server({}, {}, host);
  std::atomic<bool> enough = false;
  std::vector<std::thread> senders;
  senders.reserve(3);
  for (std::uint32_t stream = 0; stream < 3; ++stream) {
    senders.emplace_back([&server, &enough, stream] {
      for (int number = 0; !enough; ++number) {
        const auto message = numbered(number, 100);
        for (ClientId client = 1; client < 40; ++client) server.post(client, stream, message);
        server.send(static_cast<ClientId>(number % 40), "text");
        std::this_thread::yield();
      }
    });
  }
  for (int i = 0; i < 30; ++i) {
    RawClient client = connected(server);
    for (int frame = 0; frame < 5; ++frame) EXPECT_NE(client.read_frame().opcode, 0);
    client.send_text("bye");
    EXPECT_TRUE(host.wait_for(std::to_string(i + 1) + " said bye"));
  }
  enough = true;
  for (std::thread& sender : senders) sender.join();
}

}  // namespace
}  // namespace flexura
