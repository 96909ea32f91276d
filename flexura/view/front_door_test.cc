// Concurrency: messages and documents from several threads at once, while time advances.
#include "flexura/view/front_door.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Counts messages from any thread.
class CountingMessenger : public Messenger {
 public:
  void send(ClientId client, std::string text) override {
    const std::lock_guard lock(mutex_);
    ++texts_[client];
    all_.push_back(text);
    last_ = std::move(text);
  }
  void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string>) override {
    if (client == broken) throw std::runtime_error("nothing goes there,\nat all");
    const std::lock_guard lock(mutex_);
    ++posts_[{client, stream}];
  }
  [[nodiscard]] bool has_room(ClientId client) const override { return client != slow; }
  // Returns the number of texts that contain `part`.
  [[nodiscard]] std::ptrdiff_t count(const std::string& part) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::count_if(
        all_, [&](const std::string& text) { return text.find(part) != std::string::npos; });
  }
  [[nodiscard]] std::vector<std::string> all() const {
    const std::lock_guard lock(mutex_);
    return all_;
  }
  [[nodiscard]] int texts(ClientId client) const {
    const std::lock_guard lock(mutex_);
    const auto found = texts_.find(client);
    return found == texts_.end() ? 0 : found->second;
  }
  [[nodiscard]] int posts(ClientId client, std::uint32_t stream) const {
    const std::lock_guard lock(mutex_);
    const auto found = posts_.find({client, stream});
    return found == posts_.end() ? 0 : found->second;
  }
  [[nodiscard]] std::string last() const {
    const std::lock_guard lock(mutex_);
    return last_;
  }

  std::atomic<ClientId> broken = 0, slow = 0;

 private:
  mutable std::mutex mutex_;
  std::map<ClientId, int> texts_;
  std::map<std::pair<ClientId, std::uint32_t>, int> posts_;
  std::vector<std::string> all_;
  std::string last_;
};

// Waits for a condition that becomes true soon on any machine that works.
template <class Done>
bool soon(Done&& done) {
  for (int i = 0; i < 3000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

class FrontDoorTest : public ::testing::Test {
 protected:
  void start(FrontDoor& door) {
    door.start({.session = "1", .rig = viewed_rig(), .results = folder_.path() / "run"}, messenger_);
  }
  TemporaryFolder folder_;
  CountingMessenger messenger_;
};

TEST_F(FrontDoorTest, LetsTimeGoOnWhileSomeoneLooks) {
  FrontDoor door({.clock = wall_clock});
  start(door);
  door.opened(1);
  EXPECT_TRUE(soon([&] { return messenger_.posts(1, 0) >= 30; }));
  door.closed(1);
  door.opened(2);
  EXPECT_TRUE(soon([&] { return messenger_.posts(2, 0) >= 5; }));
}

TEST_F(FrontDoorTest, TakesEverythingAtOnceFromSeveralThreads) {
  FrontDoor door({.clock = wall_clock});
  start(door);
  std::atomic<int> documents = 0;
  std::vector<std::thread> threads;
  for (ClientId client = 1; client <= 3; ++client) {
    threads.emplace_back([&, client] {
      door.opened(client);
      door.on_message(client, R"({"id":1,"do":"images","camera":"front","rate":30})");
      for (int i = 0; i < 20; ++i) {
        door.on_message(client, R"({"id":2,"do":"tip","position":[-0.2,0.8,0.1]})");
        door.on_message(client, R"({"id":3,"do":"pixel","camera":"front","u":3,"v":4})");
        door.asked("/image/side.png", [&](const HttpAnswer&) { ++documents; });
      }
      door.on_message(client, R"({"id":4,"do":"run","speed":0})");
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(soon([&] { return documents == 60; }));
  for (ClientId client = 1; client <= 3; ++client) {
    EXPECT_TRUE(soon([&] { return messenger_.texts(client) >= 43; })) << messenger_.texts(client);
    EXPECT_TRUE(soon([&] { return messenger_.posts(client, 1) == 1; }));
  }
  door.stop();
}

TEST_F(FrontDoorTest, RefusesWhatOneClientHeapsUp) {
  FrontDoor door({.clock = wall_clock, .waiting_of_a_client = 2, .waiting_documents = 2});
  int refused = 0;
  // The viewer is not started yet.
  for (int i = 0; i < 5; ++i) {
    door.on_message(1, R"({"id":1,"do":"ping"})");
    door.asked("/report", [&](const HttpAnswer& answer) { refused += answer.status == 503 ? 1 : 0; });
  }
  EXPECT_EQ(refused, 3);
  start(door);
  door.opened(1);
  EXPECT_TRUE(soon([&] { return messenger_.posts(1, 0) > 0; }));
}

const std::string too_many = R"({"type":"reply","id":null,"error":"too many requests wait"})";

TEST_F(FrontDoorTest, TellsAClientWhichOfItsRequestsAreTooMany) {
  FrontDoor door({.clock = wall_clock, .waiting_of_a_client = 2});
  start(door);
  messenger_.slow = 1;
  door.opened(1);
  door.opened(2);
  for (int i = 0; i < 5; ++i) door.on_message(1, R"({"id":1,"do":"ping"})");
  EXPECT_EQ(messenger_.count(too_many), 3);
  door.on_message(2, R"({"id":7,"do":"ping"})");
  EXPECT_TRUE(soon([&] { return messenger_.count(R"("id":7,"result")") == 1; }));
  EXPECT_EQ(messenger_.count(R"("id":1,)"), 0) << "whoever does not read is asked for nothing more";
  messenger_.slow = 0;
  EXPECT_TRUE(soon([&] { return messenger_.count(R"("id":1,"result")") == 2; }));
  // Requests with an answer do not count as waiting.
  EXPECT_TRUE(soon([&] {
    door.on_message(1, R"({"id":3,"do":"ping"})");
    return messenger_.count(R"("id":3,"result")") > 10;
  }));
}

TEST_F(FrontDoorTest, KeepsTheOrderOfWhatASlowClientAsks) {
  FrontDoor door({.clock = wall_clock});
  start(door);
  messenger_.slow = 1;
  door.opened(1);
  for (int i = 10; i < 60; ++i) {
    door.on_message(1, R"({"do":"ping","id":)" + std::to_string(i) + '}');
    if (i == 35) messenger_.slow = 0;
  }
  EXPECT_TRUE(soon([&] { return messenger_.count("\"result\"") == 50; }));
  const std::vector<std::string> all = messenger_.all();
  EXPECT_TRUE(std::is_sorted(all.begin() + 1, all.end())) << "but for hello";
}

// A request being processed counts as waiting until it has its answer, like one not begun.
TEST_F(FrontDoorTest, CountsRequestsUntilTheyAreAnswered) {
  FrontDoor door({.clock = wall_clock, .waiting_of_a_client = 1});
  start(door);
  door.opened(1);
  door.opened(2);
  std::promise<void> go;
  // The thread that renders this picture and then answers for the pixel is blocked.
  door.asked("/image/front.png", [gone = go.get_future().share()](const HttpAnswer&) { gone.wait(); });
  door.on_message(1, R"({"id":2,"do":"pixel","camera":"front","u":3,"v":4})");
  door.on_message(2, R"({"id":9,"do":"ping"})");
  EXPECT_TRUE(soon([&] { return messenger_.count(R"("id":9,"result")") == 1; })) << "so the pixel is begun";
  door.on_message(1, R"({"id":3,"do":"ping"})");
  EXPECT_EQ(messenger_.count(too_many), 1);
  go.set_value();
  EXPECT_TRUE(soon([&] { return messenger_.count(R"("id":2,"result")") == 1; }));
  EXPECT_TRUE(soon([&] {
    door.on_message(1, R"({"id":4,"do":"ping"})");
    return messenger_.count(R"("id":4,"result")") > 0;
  }));
}

TEST_F(FrontDoorTest, TellsWhatFailsAndGoesOn) {
  FrontDoor door({.clock = wall_clock});
  start(door);
  messenger_.broken = 1;
  door.opened(1);
  const std::string failure = R"({"type":"reply","id":null,"error":"nothing goes there, at all"})";
  EXPECT_TRUE(soon([&] { return messenger_.count(failure) == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  messenger_.broken = 0;
  const int before = messenger_.posts(1, 0);
  EXPECT_TRUE(soon([&] { return messenger_.posts(1, 0) > before + 5; })) << "time goes on";
  EXPECT_EQ(messenger_.count(failure), 1) << "the same is said once, not 60 times a second";
  door.on_message(1, R"({"id":4,"do":"ping"})");
  EXPECT_TRUE(soon([&] { return messenger_.count(R"("id":4,"result")") == 1; }));
}

TEST_F(FrontDoorTest, SaysWhatKeepsTheViewerFromBeingMade) {
  FrontDoor door({.clock = []() -> double { throw std::runtime_error("no time"); }});
  EXPECT_THROW(start(door), std::runtime_error);
}

TEST(Workers, HandBackWhatAJobThrows) {
  std::promise<std::string> reported;
  Workers workers([&](const Background::After& after) {
    try {
      after();
    } catch (const std::exception& error) {
      reported.set_value(error.what());
    }
  });
  workers.run(Lane::checks, []() -> Background::After { throw std::runtime_error("too much"); });
  EXPECT_EQ(reported.get_future().get(), "too much");
}

TEST_F(FrontDoorTest, EndsInTheMiddleOfARun) {
  FrontDoor door({.clock = wall_clock});
  door.start({.session = "1",
              .rig = viewed_rig(viewed_text + "[[task]]\nkind = 'hold'\nduration = 19000\n"),
              .results = folder_.path() / "run"},
             messenger_);
  door.opened(1);
  door.on_message(1, R"({"id":1,"do":"run"})");
  EXPECT_TRUE(soon([&] { return messenger_.last().find("progress") != std::string::npos; }));
  door.stop();
  const int posts = messenger_.posts(1, 0);
  door.on_message(1, R"({"id":2,"do":"ping"})");
  EXPECT_EQ(messenger_.posts(1, 0), posts);
}

}  // namespace
}  // namespace flexura
