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
#include "tests/support/view_client.h"
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
  RawClient client = connected(server, receive_buffer);
  for (const char* camera : {"front", "side"})
    client.send_text(std::string(R"({"id":1,"do":"images","rate":30,"quality":95,"camera":")") + camera +
                     "\"}");
  return client;
}

// A client that never reads, but says that every picture has come: so the server goes on sending until the
// system takes no more of it.
class DeafClient {
 public:
  explicit DeafClient(const ViewServer& server) : client_(watching(server, 4096)) {}

  // Its pictures are those of all others, but may be a little ahead of them or behind.
  void acknowledge_around(const char* camera, int number) const {
    for (int near = std::max(0, number - 2); near <= number + 1; ++near) client_.send_text(ack(camera, near));
  }

  static std::string ack(const std::string& camera, int number) {
    return R"({"do":"ack","camera":")" + camera + R"(","number":)" + std::to_string(number) + "}";
  }

 private:
  RawClient client_;
};

struct Seen {
  int states = 0;
  int made = 0;  // by the server meanwhile
  int images = 0;
  double simulated = 0;          // s that the rig's time went on
  double wall = 0;               // s
  std::size_t least_busy = 0;    // clients to whom something was being sent, at the least
  std::size_t most_waiting = 0;  // bytes, for all clients
};

// What a client that reads and acknowledges everything sees in so many s, beside deaf ones.
Seen watch(const ViewServer& server, RawClient& client, double seconds,
           const std::vector<DeafClient>& deaf = {}) {
  Seen seen;
  seen.least_busy = server.busy_clients();
  std::optional<StateMessage> first;
  const auto start = Clock::now();
  while (seconds_since(start) < seconds) {
    const RawFrame frame = client.read_frame();
    seen.least_busy = std::min(seen.least_busy, server.busy_clients());
    seen.most_waiting = std::max(seen.most_waiting, server.waiting_bytes());
    if (frame.opcode != 2) continue;
    if (const auto state = read_state_message(frame.payload)) {
      if (!first) first = state;
      seen.simulated = state->time - first->time;
      seen.made = static_cast<int>(state->sequence - first->sequence) + 1;
      ++seen.states;
    } else if (frame.payload.at(0) == 2) {
      ++seen.images;
      const char* camera = frame.payload[1] == 0 ? "front" : "side";
      const int number =
          static_cast<unsigned char>(frame.payload[4]) + 256 * static_cast<unsigned char>(frame.payload[5]);
      client.send_text(DeafClient::ack(camera, number));
      for (const DeafClient& other : deaf) other.acknowledge_around(camera, number);
    }
  }
  seen.wall = seconds_since(start);
  return seen;
}

// Four that do not read, and to all of whom the server cannot send any more; fewer where that takes too long.
std::vector<DeafClient> blocked_clients(const ViewServer& server, RawClient& good) {
  std::vector<DeafClient> deaf;
  deaf.reserve(4);
  for (int i = 0; i < 4; ++i) deaf.emplace_back(server);
  constexpr int patience = 100;
  for (int i = 0; i < patience && watch(server, good, 0.1, deaf).least_busy < deaf.size(); ++i) {
  }
  return deaf;
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
  good.send_text(R"({"id":2,"do":"arm","bends":[[-0.8,0.3],[0.4,0.5]],"duration":60})");
  (void)watch(server, good, seconds);
  const std::size_t before = resident_bytes();
  std::size_t most = 0, most_waiting = 0;
  std::vector<double> seen, states, images, pace;  // shares of what there was, or is without deaf ones
  for (int round = 0; static_cast<int>(pace.size()) < rounds; ++round) {
    const Seen alone = watch(server, good, seconds);
    // On a busy machine something may be on its way to the good client whenever it is looked: then who is
    // blocked cannot be told, and another round is taken.
    if (alone.least_busy > 0 && round < 3 * rounds) continue;
    const std::vector<DeafClient> deaf = blocked_clients(server, good);
    const Seen among = watch(server, good, seconds, deaf);
    most = std::max(most, resident_bytes());
    most_waiting = std::max(most_waiting, among.most_waiting);
    ASSERT_EQ(alone.least_busy, 0U) << "else what follows says nothing";
    ASSERT_GE(among.least_busy, deaf.size()) << "what is sent to the deaf does not block";
    ASSERT_GT(std::min({alone.made, alone.images, among.made}), 0);
    seen.push_back(static_cast<double>(among.states) / among.made);
    states.push_back(among.made / among.wall / (alone.made / alone.wall));
    images.push_back(among.images / among.wall / (alone.images / alone.wall));
    pace.push_back(among.simulated / among.wall / (alone.simulated / alone.wall));
  }
  std::cout << "of the states there are " << median(seen) << " are seen; states " << median(states)
            << ", pictures " << median(images) << " and pace " << median(pace)
            << " of what comes without deaf clients; memory " << (most - std::min(most, before)) / 1024
            << " KiB more, " << most_waiting / 1024 << " KiB wait\n";
  EXPECT_GT(median(seen), 0.9) << "of what there was to see next to nothing is lost";
  EXPECT_GT(median(states), 0.9);
  EXPECT_GT(median(images), 0.8);
  EXPECT_GT(median(pace), 0.8);
  EXPECT_LT(most, before + (std::size_t{64} << 20));
  // A state and two pictures wait for each client, and one more is being sent: none of them has 15 kB.
  EXPECT_LT(most_waiting, std::size_t{5} * 4 * 15'000);
}

}  // namespace
}  // namespace flexura
