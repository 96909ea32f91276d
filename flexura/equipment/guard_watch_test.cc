#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "flexura/equipment/guard_process.h"

// The decisions of the guard, in simulated time.
namespace flexura {
namespace {

// Keeps what is sent, and when.
class KeptWatch : public GuardWatch {
 public:
  explicit KeptWatch(double period) : GuardWatch(period) {
    heed(guard_message({.first = {"brake;"}, .delay = 0.1, .then = {"reset;"}}, "device"), 0, 0);
  }
  void say(GuardMessage::Kind kind, double now) {
    GuardMessage message;
    message.kind = kind;
    heed(message, -1, now);
  }
  // Does what is due until `end`, at the times that due() names. Returns the number of missing beats.
  int run_to(double end) {
    int missing = 0;
    while (due() <= end) {
      now_ = due() + 1e-9;
      if (advance(now_)) ++missing;
    }
    return missing;
  }
  std::vector<double> brakes, resets;  // Times, s.

 private:
  void send(int /*link*/, const char* bytes, std::size_t size) noexcept override {
    (std::string(bytes, size) == "brake;" ? brakes : resets).push_back(now_);
  }
  void send_to_address(std::size_t /*device*/, const GuardMessage& /*stop*/) noexcept override {}
  double now_ = 0;
};

TEST(GuardWatch, RepeatsTheStopUntilTheNextBeat) {
  KeptWatch watch(0.5);
  watch.say(GuardMessage::Kind::moving, 1);
  EXPECT_EQ(watch.run_to(1.4), 0);
  EXPECT_TRUE(watch.brakes.empty());
  EXPECT_EQ(watch.run_to(4), 1) << "the program learns only once that its devices were stopped";
  ASSERT_GT(watch.brakes.size(), 5U);
  EXPECT_NEAR(watch.brakes[0], 1.5, 1e-6);
  for (std::size_t i = 0; i < watch.resets.size(); ++i)
    EXPECT_NEAR(watch.resets[i], watch.brakes[i] + 0.1, 1e-6) << "each stop is a whole one";
  for (std::size_t i = 1; i < watch.brakes.size(); ++i)
    EXPECT_NEAR(watch.brakes[i] - watch.brakes[i - 1], 0.3, 1e-6);
  for (const auto beat : {GuardMessage::Kind::resting, GuardMessage::Kind::moving, GuardMessage::Kind::end}) {
    KeptWatch other(0.5);
    other.say(GuardMessage::Kind::moving, 1);
    EXPECT_EQ(other.run_to(2), 1);
    const std::size_t before = other.brakes.size();
    other.say(beat, 2);
    (void)other.run_to(2.4);
    EXPECT_EQ(other.brakes.size(), before) << "a stop after a beat would stop what the program does now";
  }
}

TEST(GuardWatch, RepeatsTheStopOfALostProgramAndEnds) {
  KeptWatch watch(0.5);
  watch.say(GuardMessage::Kind::resting, 1);
  watch.lose_program(1.1);
  EXPECT_TRUE(watch.is_over());
  EXPECT_EQ(watch.run_to(100), 0);
  EXPECT_EQ(watch.brakes.size(), 5U);
  EXPECT_EQ(watch.resets.size(), 5U);
  EXPECT_EQ(watch.due(), HUGE_VAL);
}

TEST(GuardWatch, AStopOnRequestIsNotRepeated) {
  KeptWatch watch(0.5);
  watch.say(GuardMessage::Kind::resting, 1);
  watch.say(GuardMessage::Kind::stop, 2);
  (void)watch.run_to(100);
  EXPECT_EQ(watch.brakes.size(), 1U);
  EXPECT_EQ(watch.resets.size(), 1U);
}

}  // namespace
}  // namespace flexura
