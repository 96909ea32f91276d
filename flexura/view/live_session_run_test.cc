#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "flexura/store/text_file.h"
#include "flexura/view/live_session.h"
#include "tests/support/experiment_files.h"
#include "tests/support/live_sessions.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Returns the time in an image's message.
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
  const ViewAnswer answer = ask(RunRequest{.task = {}, .speed = 0});
  ASSERT_EQ(answer.error, "");
  const std::filesystem::path results = *answer.result.find("folder")->as<std::string>();
  EXPECT_TRUE(pass(0.1).is_running);
  EXPECT_THAT(ask(bends({{0, 0}, {0, 0}})).error, HasSubstr("a run of tasks is active"));
  background_.work();
  EXPECT_FALSE(session_.results());
  EXPECT_FALSE(pass(0.1).is_running);
  EXPECT_EQ(session_.results(), results);
  EXPECT_TRUE(std::filesystem::exists(results / "summary.json"));
  const Node progress = messenger_.last(me, "progress");
  EXPECT_TRUE(*progress.find("done")->as<bool>());
  EXPECT_EQ(*progress.find("outcome")->as<std::string>(), "done");
  EXPECT_THAT(*progress.find("text")->as<std::string>(), HasSubstr("at the target shape"))
      << "what came of the run";
}

// The settings are in the results, so the run can be repeated.
TEST_F(LiveSessionTest, RunsTasksWithTheRegionThatAClientDrew) {
  RunRequest run;
  run.speed = 0;
  run.seeing.resize(1);
  run.seeing[0].camera = "back";
  EXPECT_THAT(ask(run).error, HasSubstr("there is no camera with this name"));
  run.seeing[0].camera = "front";
  run.seeing[0].region = {{3, 4}, {50, 60}};
  const ViewAnswer answer = ask(run);
  ASSERT_EQ(answer.error, "");
  const std::filesystem::path results = *answer.result.find("folder")->as<std::string>();
  pass(0.1);
  const std::string file = read_text_file(results / "experiment.toml", 1 << 20);
  EXPECT_THAT(file, HasSubstr("seeing"));
  EXPECT_THAT(file, HasSubstr("60"));
  EXPECT_TRUE(rig_->experiment.seeing.empty()) << "the rig itself stays as it is";
}

TEST_F(LiveSessionTest, RunsOneTaskFromTheStart) {
  const ViewedRigPtr rig = viewed_rig(viewed_text + "[[task]]\nkind = \"hold\"\nduration = 0.5\n");
  LiveSession session(rig, messenger_, background_, {.start = 0, .results = folder_.path() / "one"});
  session.opened(other);
  session.take(other, RunRequest{.task = 1, .speed = 0},
               [](const ViewAnswer& answer) { EXPECT_EQ(answer.error, ""); });
  session.advance(0.1);
  const auto summary = folder_.path() / "one" / "summary.json";
  const Node reported = parse_json(read_text_file(summary, 1 << 20), "summary");
  ASSERT_EQ(reported.find("tasks")->as<Node::Array>()->size(), 1);
  EXPECT_EQ(*reported.find("tasks")->as<Node::Array>()->front().find("kind")->as<std::string>(), "hold");
  EXPECT_EQ(*reported.find("duration")->as<double>(), 0.5);
  EXPECT_EQ(ask(RunRequest{.task = 1, .speed = 0}).error, "task = 1: expected 0 to 0");
  EXPECT_THAT(messenger_.last(me, "progress").find("what"), nullptr) << "that was refused";
}

// Ends what a test has begun, whatever comes of the test.
class RunningSessionTest : public LiveSessionTest {
 protected:
  using LiveSessionTest::LiveSessionTest;
  ~RunningSessionTest() override { end(); }
  // Starts the tasks, which go on beside the test as the program's do.
  void start(double speed) {
    background_.is_prompt = false;
    ASSERT_EQ(ask(RunRequest{.task = {}, .speed = speed}).error, "");
    runner_ = std::thread([this] { background_.work(); });
    // A slow machine needs a while until the arm moves.
    pass_run(1.0 / 60);
    for (int i = 0; i < 20000 && !(messenger_.state(me).arm.bends[0].norm() > 0); ++i) pass_run(1.0 / 60);
  }
  // Goes on, as fast as the run can follow, until the run's motion is over or the test's patience is.
  void pass_run(double seconds) {
    for (const double end = clock_ + seconds; clock_ < end - 1e-9;) {
      session_.advance(clock_ += 1.0 / 60);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  StateMessage wait_for_end() {
    for (int i = 0; i < 20000 && session_.is_running(); ++i) pass_run(1.0 / 60);
    EXPECT_FALSE(session_.is_running());
    end();
    return messenger_.state(me);
  }
  void end() {
    session_.cancel();
    if (runner_.joinable()) runner_.join();
    background_.is_prompt = true;
  }

 private:
  std::thread runner_;
};

TEST_F(RunningSessionTest, PlaysTasksInRealTimeAndStaysWhereTheyEnd) {
  start(1);
  pass_run(0.3);
  EXPECT_TRUE(session_.is_running()) << "a task of 1 s";
  EXPECT_LT(messenger_.state(me).arm.bends[0].x(), 0.45) << "of 0.8, which it has after 1 s";
  const double begun = clock_;
  const int leaps = messenger_.state(me).leaps;
  EXPECT_NEAR(wait_for_end().arm.bends[0].x(), 0.8, 1e-6);
  EXPECT_GT(clock_ - begun, 0.55);
  const StateMessage later = pass(1);
  EXPECT_NEAR(later.arm.bends[0].x(), 0.8, 1e-6) << "it stays there";
  EXPECT_NEAR(later.arm.bends[1].y(), 0.7, 1e-6);
  EXPECT_EQ(later.leaps, leaps) << "and came there by no leap";
  ask(ResetRequest{});
  EXPECT_EQ(pass(0.1).arm.bends[0].x(), 0);
}

TEST_F(RunningSessionTest, HaltsTasksWhereTheyAre) {
  start(1);
  pass_run(0.3);
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  const double halted = wait_for_end().arm.bends[0].x();
  EXPECT_GT(halted, 0);
  EXPECT_LT(halted, 0.6);
  EXPECT_EQ(*messenger_.last(me, "progress").find("outcome")->as<std::string>(), "cancelled");
  EXPECT_NEAR(pass(1).arm.bends[0].x(), halted, 1e-6);
  EXPECT_EQ(ask(bends({{0.1, 0}, {0, 0}})).error, "");
  EXPECT_NEAR(pass(5).arm.bends[0].x(), 0.1, 1e-6) << "it goes on from there";
}

// One condition, which every client knows.
TEST_F(RunningSessionTest, SaysInWhichConditionItIs) {
  const auto condition = [&](ClientId client = me) {
    const Node reported = messenger_.last(client, "condition");
    return reported.empty() ? "" : *reported.find("condition")->as<std::string>();
  };
  EXPECT_EQ(condition(), "idle") << "as it comes";
  ask(bends({{0.1, 0}, {0.5, 0}}));
  pass(0.1);
  EXPECT_EQ(condition(), "moving");
  pass(3);
  EXPECT_EQ(condition(), "idle");
  start(1);
  pass_run(0.2);
  EXPECT_EQ(condition(), "running");
  session_.opened(other);
  EXPECT_EQ(condition(other), "running") << "who comes later knows it too";
  wait_for_end();
  EXPECT_EQ(condition(), "done");
  ask(bends({{0.1, 0}, {0.5, 0}}));
  pass(0.1);
  EXPECT_EQ(condition(), "moving");
  ask(HaltRequest{});
  pass(0.1);
  EXPECT_EQ(condition(), "halted");
  ask(ResetRequest{});
  pass(0.1);
  EXPECT_EQ(condition(), "idle");
}

// The task leads beyond the limit of a section.
class UnsafeSessionTest : public RunningSessionTest {
 protected:
  UnsafeSessionTest()
      : RunningSessionTest(replaced(viewed_text, "bends = [[0.8, 0.5]", "bends = [[2.5, 0]")) {}
};

TEST_F(UnsafeSessionTest, SaysThatItIsUnsafeAndWas) {
  start(1);
  pass_run(0.1);
  EXPECT_EQ(*messenger_.last(me, "condition").find("condition")->as<std::string>(), "running");
  EXPECT_FALSE(messenger_.state(me).is_unsafe);
  wait_for_end();
  const Node reported = messenger_.last(me, "condition");
  EXPECT_EQ(*reported.find("condition")->as<std::string>(), "unsafe");
  EXPECT_THAT(*reported.find("text")->as<std::string>(), HasSubstr("section"));
  EXPECT_TRUE(pass(0.1).is_unsafe);
  ask(ResetRequest{});
  EXPECT_FALSE(pass(0.1).is_unsafe);
}

TEST_F(RunningSessionTest, PlaysOnFasterWhenThatIsAsked) {
  EXPECT_THAT(ask(SpeedRequest{4}).error, HasSubstr("no run is active"));
  start(0.001);
  pass_run(0.2);
  EXPECT_TRUE(session_.is_running());
  EXPECT_EQ(ask(SpeedRequest{0}).error, "");
  EXPECT_NEAR(wait_for_end().arm.bends[0].x(), 0.8, 1e-6);
}

// Its rig is the one that the tasks have played: also what nobody has commanded stays.
class SwungArmTest : public RunningSessionTest {
 protected:
  SwungArmTest()
      : RunningSessionTest(viewed_text + R"(
[[truth.camera]]
name = "front"
initial = { pan = 0.1 }
[[truth.arm.section]]
length = 0.51
[[truth.arm.section]]
)") {}
};

TEST_F(SwungArmTest, StaysAsTheRigOfItsTasksStands) {
  start(0);
  const StateMessage state = wait_for_end();
  EXPECT_NEAR(state.arm.bends[0].x(), 0.8, 1e-6);
  EXPECT_NEAR(state.cameras[0].head.pan, 0.1, 1e-6) << "as it truly is";
  EXPECT_NEAR(pass(1).samples.back().s, 1.01, 1e-6) << "the true arm";
}

TEST_F(LiveSessionTest, CancelsARun) {
  EXPECT_THAT(ask(CancelRequest{}).error, HasSubstr("no run is active"));
  background_.is_prompt = false;
  ask(RunRequest{.task = {}, .speed = 0});
  EXPECT_EQ(ask(CancelRequest{}).error, "");
  background_.work();
  pass(0.1);
  EXPECT_EQ(*messenger_.last(me, "progress").find("outcome")->as<std::string>(), "cancelled");
}

TEST_F(LiveSessionTest, HaltsARunTogetherWithEverythingElse) {
  background_.is_prompt = false;
  ask(RunRequest{.task = {}, .speed = 0});
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
  EXPECT_TRUE(messenger_.last(other, "progress").find("left")->empty()) << "not known yet";
  run->update(0.75, "bend");
  watched.advance(109.1);
  EXPECT_NEAR(*messenger_.last(other, "progress").find("left")->as<double>(), 3, 1e-9);
  EXPECT_THROW(watched.take(other, bends({{0, 0}, {0, 0}}), [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_THROW(watched.take(other, CancelRequest{}, [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_THROW(watched.take(other, HaltRequest{}, [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_FALSE(run->is_cancelled()) << "what is seen changes nothing of a run";
  run->finish({"unsafe", "section 1: bend", folder_.path()});
  watched.advance(100.2);
  EXPECT_TRUE(watched.is_over());
  EXPECT_EQ(*messenger_.last(other, "progress").find("text")->as<std::string>(), "section 1: bend");
}

TEST_F(LiveSessionTest, PlaysARunOfSomebodyElseAtASpeed) {
  auto run = std::make_shared<RunLink>();
  LiveSession watched(rig_, messenger_, background_, {.start = 100, .results = {}, .run = run, .speed = 1});
  EXPECT_TRUE(watched.is_pacing()) << "also if nobody looks";
  EXPECT_EQ(watched.hello().speed, 1);
  std::atomic<double> reached = -1;
  std::thread runs([&] {
    for (int i = 0; i <= 200; ++i) {
      run->state(0.02 * i, {{{0.1, 0.2}, {0.3, 0.4}}, {1, 1}}, {});
      reached = 0.02 * i;
    }
    run->finish({"done", "", folder_.path()});
  });
  const auto wait_for = [&](double time) {
    while (reached < time) std::this_thread::yield();
  };
  double clock = 100;
  while (reached < 0.5) {
    watched.advance(clock += 1.0 / 60);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    // It may be a little ahead of the clock, and never far.
    EXPECT_LE(reached, clock - 100 + 0.11);
  }
  watched.take(other, SpeedRequest{0}, [](const ViewAnswer& answer) { EXPECT_EQ(answer.error, ""); });
  EXPECT_FALSE(watched.is_pacing());
  watched.advance(clock += 1.0 / 60);
  wait_for(4);
  runs.join();
  watched.advance(clock += 1.0 / 60);
  EXPECT_TRUE(watched.is_over());
}

// A run may be much faster or slower than the clock: a picture's time identifies the state that it shows.
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

// A run started by the page uses the page's time, which goes on; so do its pictures.
TEST_F(LiveSessionTest, GivesPicturesTheTimeOfTheStatesOfAFreeRig) {
  ask(ImagesRequest{"front", 30, 80});
  for (int i = 0; i < 5; ++i) {
    const StateMessage state = pass(0.4);  // The picture was taken at the first of these ticks.
    const std::string image = last_image(me, 1);
    EXPECT_LE(image_time(image), state.time);
    EXPECT_GT(image_time(image), state.time - 0.45);
    ask(AckRequest{"front", image_number(image)});
  }
}

}  // namespace
}  // namespace flexura
