// A live rig behind its server, and clients that ask for more than it can answer at once.
#include "flexura/view/view_server.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "tests/support/raw_client.h"
#include "tests/support/view_client.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

struct Replies {
  int results = 0, refusals = 0;
};

// A client that asks and reads at once.
class Talk {
 public:
  explicit Talk(RawClient client) : client_(std::move(client)) {}

  void send_text(const std::string& request) {
    const std::lock_guard lock(sending_);
    client_.send_text(request);
  }
  // The next frame but pings, which are answered; where a request is on its way, that is answer enough.
  RawFrame read_frame() {
    for (;;) {
      RawFrame frame = client_.read_frame();
      constexpr int ping = 9, whole_pong = 0x8A;
      if (frame.opcode != ping) return frame;
      if (const std::unique_lock lock(sending_, std::try_to_lock); lock)
        client_.send_frame(whole_pong, frame.payload);
    }
  }

 private:
  RawClient client_;
  std::mutex sending_;
};

// So many replies, or fewer where the client is cut off.
Replies answers_in(Talk& client, int count) {
  Replies replies;
  while (replies.results + replies.refusals < count) {
    const RawFrame frame = client.read_frame();
    if (frame.opcode != 1 && frame.opcode != 2) break;
    if (frame.payload.starts_with(R"({"type":"reply","id":1,"result")")) ++replies.results;
    if (frame.payload == R"({"type":"reply","id":null,"error":"too many requests wait"})") ++replies.refusals;
  }
  return replies;
}

// What comes of so many requests, all at once, to a client that reads.
Replies replies_to(const ViewServer& server, const std::string& request, int count) {
  Talk client(connected(server));
  std::thread asking([&] {
    for (int i = 0; i < count; ++i) client.send_text(request);
  });
  const Replies replies = answers_in(client, count);
  asking.join();
  return replies;
}

constexpr int many = 400;

// An arm of so many sections that what is said of all of it is 25 kB, of which 4 MB hold less than two
// hundred.
ViewedRigPtr long_rig() {
  std::string text = "[arm]\nkind = 'spatial'\n";
  for (int i = 0; i < many; ++i) text += "[[arm.section]]\nlength = 0.1\n";
  return viewed_rig(text);
}

std::string long_request() {
  std::string bends = "[0.01,0.02]";
  for (int i = 1; i < many; ++i) bends += ",[0.01,0.02]";
  return R"({"id":1,"do":"backbone","bends":[)" + bends + "]}";
}

TEST(ViewServer, AnswersEachRequestOfAClientThatReads) {
  const ViewServer server({.session = "1", .rig = long_rig()}, {}, {});
  for (const auto& [request, count] :
       {std::pair(std::string(R"({"id":1,"do":"ping"})"), 3000), std::pair(long_request(), 1000)}) {
    const Replies replies = replies_to(server, request, count);
    EXPECT_EQ(replies.results + replies.refusals, count) << request;
    EXPECT_GE(replies.results, 256) << request;
  }
}

TEST(ViewServer, HoldsLittleForAClientThatReadsLateAndAnswersAllTheSame) {
  const ViewServer server({.session = "1", .rig = long_rig()}, {}, {});
  Talk late(connected(server, 4096));
  constexpr int count = 250;  // so that none is refused
  std::thread asking([&] {
    for (int i = 0; i < count; ++i) late.send_text(long_request());
  });
  constexpr std::size_t room = std::size_t{1} << 20;
  constexpr int patience = 3000;
  for (int i = 0; i < patience && server.waiting_bytes() < room; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_GE(server.waiting_bytes(), room);
  EXPECT_LT(server.waiting_bytes(), room + room / 4);
  EXPECT_EQ(answers_in(late, count).results, count);
  asking.join();
}

}  // namespace
}  // namespace flexura
