#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include "flexura/store/text_file.h"
#include "flexura/view/live_session.h"
#include "tests/support/live_sessions.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// What an image's message says of itself.
double image_time(const std::string& message) {
  double time = 0;
  std::memcpy(&time, message.data() + 8, sizeof(time));
  return time;
}
std::uint32_t image_number(const std::string& message) {
  std::uint32_t number = 0;
  std::memcpy(&number, message.data() + 4, sizeof(number));
  return number;
}

TEST_F(LiveSessionTest, RunsTheTasksIntoANewFolder) {
  background_.is_prompt = false;
  const ViewAnswer answer = ask(RunRequest{});
  ASSERT_EQ(answer.error, "");
  const std::filesystem::path results = *answer.result.find("folder")->as<std::string>();
  EXPECT_TRUE(pass(0.1).is_running);
  EXPECT_THAT(ask(bends({{0, 0}, {0, 0}})).error, HasSubstr("a run of tasks is going on"));
  background_.work();
  EXPECT_FALSE(session_.results());
  EXPECT_FALSE(pass(0.1).is_running);
  EXPECT_EQ(session_.results(), results);
  EXPECT_TRUE(std::filesystem::exists(results / "summary.json"));
  const Node progress = messenger_.last(me, "progress");
  EXPECT_TRUE(*progress.find("done")->as<bool>());
  EXPECT_EQ(*progress.find("outcome")->as<std::string>(), "done");
}

TEST_F(LiveSessionTest, RunsOneTaskFromTheStart) {
  const ViewedRigPtr rig = viewed_rig(viewed_text + "[[task]]\nkind = \"hold\"\nduration = 0.5\n");
  LiveSession session(rig, messenger_, background_, {.start = 0, .results = folder_.path() / "one"});
  session.opened(other);
  session.take(other, RunRequest{1}, [](const ViewAnswer& answer) { EXPECT_EQ(answer.error, ""); });
  session.advance(0.1);
  const auto summary = folder_.path() / "one" / "summary.json";
  const Node reported = parse_json(read_text_file(summary, 1 << 20), "summary");
  ASSERT_EQ(reported.find("tasks")->as<Node::Array>()->size(), 1);
  EXPECT_EQ(*reported.find("tasks")->as<Node::Array>()->front().find("kind")->as<std::string>(), "hold");
  EXPECT_EQ(*reported.find("duration")->as<double>(), 0.5);
  EXPECT_EQ(ask(RunRequest{1}).error, "task = 1: expected 0 to 0");
  EXPECT_THAT(messenger_.last(me, "progress").find("what"), nullptr) << "that was refused";
}

TEST_F(LiveSessionTest, CancelsARun) {
  EXPECT_THAT(ask(CancelRequest{}).error, HasSubstr("no run is going on"));
  background_.is_prompt = false;
  ask(RunRequest{});
  EXPECT_EQ(ask(CancelRequest{}).error, "");
  background_.work();
  pass(0.1);
  EXPECT_EQ(*messenger_.last(me, "progress").find("outcome")->as<std::string>(), "cancelled");
}

TEST_F(LiveSessionTest, HaltsARunTogetherWithEverythingElse) {
  background_.is_prompt = false;
  ask(RunRequest{});
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  background_.work();
  EXPECT_FALSE(pass(0.1).is_running);
  EXPECT_EQ(*messenger_.last(me, "progress").find("outcome")->as<std::string>(), "cancelled");
}

TEST_F(LiveSessionTest, ShowsARunThatSomebodyElseStarted) {
  auto run = std::make_shared<RunLink>();
  LiveSession watched(rig_, messenger_, background_, {.start = 100, .results = {}, .run = run});
  watched.opened(other);
  EXPECT_TRUE(watched.hello().readonly);
  run->update(0.5, "bend");
  run->state(7.25, {{{0.1, 0.2}, {0.3, 0.4}}, {1, 1}}, {});
  watched.advance(100.1);
  EXPECT_EQ(messenger_.state(other).time, 7.25);
  EXPECT_NEAR(messenger_.state(other).arm.bends[1].y(), 0.4, 1e-6);
  EXPECT_EQ(*messenger_.last(other, "progress").find("fraction")->as<double>(), 0.5);
  EXPECT_THROW(watched.take(other, bends({{0, 0}, {0, 0}}), [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_THROW(watched.take(other, CancelRequest{}, [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_THROW(watched.take(other, HaltRequest{}, [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_FALSE(run->is_cancelled()) << "what is seen changes nothing of a run";
  run->finish({"unsafe", "section 1: bend", folder_.path()});
  watched.advance(100.2);
  EXPECT_TRUE(watched.is_over());
  EXPECT_EQ(*messenger_.last(other, "progress").find("text")->as<std::string>(), "section 1: bend");
}

// A run may be many times as fast as the clock, or slower: a picture's time says of which state it is.
TEST_F(LiveSessionTest, GivesPicturesOfAWatchedRunTheTimeOfTheStateTheyShow) {
  auto run = std::make_shared<RunLink>();
  LiveSession watched(rig_, messenger_, background_, {.start = 100, .results = {}, .run = run});
  watched.opened(other);
  watched.take(other, ImagesRequest{"side", 30, 80}, [](const ViewAnswer&) {});
  std::string before;
  double clock = 100.5;
  for (const double time : {0.25, 7.25, 1907.5, 1907.625}) {
    run->state(time, {{{0.1 * std::fmod(time, 3), 0.2}, {0.3, 0.4}}, {1, 1}}, {});
    watched.advance(clock += 0.1);
    const std::string image = last_image(other, 2);
    EXPECT_NEAR(image_time(image), messenger_.state(other).time, 1e-9) << time;
    EXPECT_EQ(messenger_.state(other).time, time);
    EXPECT_NE(image.substr(16), before) << "another shape, another picture";
    before = image.substr(16);
    watched.take(other, AckRequest{"side", image_number(image)}, [](const ViewAnswer&) {});
  }
}

// What the page starts goes by the page's time, which goes on: its pictures too.
TEST_F(LiveSessionTest, GivesPicturesTheTimeOfTheStatesOfAFreeRig) {
  ask(ImagesRequest{"front", 30, 80});
  for (int i = 0; i < 5; ++i) {
    const StateMessage state = pass(0.4);  // The first of these ticks took it.
    const std::string image = last_image(me, 1);
    EXPECT_LE(image_time(image), state.time);
    EXPECT_GT(image_time(image), state.time - 0.45);
    ask(AckRequest{"front", image_number(image)});
  }
}

}  // namespace
}  // namespace flexura
