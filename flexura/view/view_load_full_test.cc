// A live rig behind its server, with clients that never read: nothing of theirs is anybody else's trouble.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "flexura/view/view_server.h"
#include "tests/support/raw_client.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// What of this process lies in memory, bytes.
std::size_t resident_bytes() {
  std::size_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// A client that has asked for both cameras' pictures.
RawClient watching(const ViewServer& server, int receive_buffer = 0) {
  RawClient client(server.port(), receive_buffer);
  client.send("GET /socket HTTP/1.1\r\nHost: localhost:" + std::to_string(server.port()) +
              "\r\nAuthorization: Bearer " + server.token() +
              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_EQ(client.read_answer().status, 101);
  for (const char* camera : {"front", "side"})
    client.say(std::string(R"({"id":1,"do":"images","rate":30,"quality":95,"camera":")") + camera + "\"}");
  return client;
}

struct Seen {
  int states = 0;
  int made = 0;  // by the server meanwhile
  int images = 0;
  double simulated = 0;  // s that the rig's time went on
  double wall = 0;       // s
};

// What a client that reads and acknowledges everything sees in so many s.
Seen watch(RawClient& client, double seconds) {
  Seen seen;
  std::optional<StateMessage> first;
  const auto start = Clock::now();
  while (seconds_since(start) < seconds) {
    const RawFrame frame = client.read_frame();
    if (frame.opcode != 2) continue;
    if (const auto state = read_state_message(frame.payload)) {
      if (!first) first = state;
      seen.simulated = state->time - first->time;
      seen.made = static_cast<int>(state->sequence - first->sequence) + 1;
      ++seen.states;
    } else if (frame.payload.at(0) == 2) {
      ++seen.images;
      const auto number =
          static_cast<unsigned char>(frame.payload[4]) + 256U * static_cast<unsigned char>(frame.payload[5]);
      client.say(R"({"do":"ack","camera":")" + std::string(frame.payload[1] == 0 ? "front" : "side") +
                 R"(","number":)" + std::to_string(number) + "}");
    }
  }
  seen.wall = seconds_since(start);
  return seen;
}

// The cameras of the other tests are small; these send as much as real ones.
ViewedRigPtr rig_with_large_pictures() {
  std::string text = viewed_text;
  for (const std::string& small :
       {std::string("width = 64, height = 48"), std::string("width = 64, height = 48")})
    text.replace(text.find(small), small.size(), "width = 640, height = 480");
  return viewed_rig(text);
}

// Of so many numbers (an odd count).
double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.at(values.size() / 2);
}

// Others may work on the machine too, and now more, now less: so times with and without the deaf clients take
// turns, each is compared with the one beside it, and what counts is the median of many.
TEST(ViewLoad, FourClientsThatNeverReadSlowNothingDownAndTakeNoMemory) {
  constexpr double seconds = 0.6;
  constexpr int rounds = 9;
  ViewServer server({.session = "1", .rig = rig_with_large_pictures()}, {}, {});
  RawClient good = watching(server);
  good.say(R"({"id":2,"do":"arm","bends":[[-0.8,0.3],[0.4,0.5]],"duration":60})");
  (void)watch(good, seconds);
  const std::size_t before = resident_bytes();
  std::size_t most = 0;
  std::vector<double> seen, states, images, pace;  // shares of what there was, or is without deaf ones
  for (int round = 0; round < rounds; ++round) {
    const Seen alone = watch(good, seconds);
    std::vector<RawClient> deaf;
    deaf.reserve(4);
    for (int i = 0; i < 4; ++i) deaf.push_back(watching(server, 4096));
    const Seen among = watch(good, seconds);
    most = std::max(most, resident_bytes());
    ASSERT_GT(std::min({alone.made, alone.images, among.made}), 0);
    seen.push_back(static_cast<double>(among.states) / among.made);
    states.push_back(among.made / among.wall / (alone.made / alone.wall));
    images.push_back(among.images / among.wall / (alone.images / alone.wall));
    pace.push_back(among.simulated / among.wall);
  }
  std::cout << "of the states there are " << median(seen) << " are seen; states " << median(states)
            << " and pictures " << median(images) << " of what comes without deaf clients; pace "
            << median(pace) << '\n';
  EXPECT_GT(median(seen), 0.9) << "of what there was to see next to nothing is lost";
  EXPECT_GT(median(states), 0.9);
  EXPECT_GT(median(images), 0.8);
  EXPECT_GT(median(pace), 0.8);
  EXPECT_LT(most, before + (std::size_t{64} << 20));
}

}  // namespace
}  // namespace flexura
