// Tests stopping a run that has no viewer.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/table.h"
#include "flexura/log/messages.h"
#include "flexura/servo/servo_step.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "tests/support/program.h"
#include "tests/support/servo_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class StoppedProgram : public Program {
 protected:
  // Starts a run and waits until its log has grown to a size.
  pid_t running(const std::string& text, std::uintmax_t size) {
    std::ofstream(path("long.toml")) << text;
    const pid_t child = start("run long.toml --out long", path("out"));
    const std::filesystem::path log = path("long/log.mcap");
    // The limit only ends a run that hangs: sanitizers on a busy machine are slow.
    for (int i = 0; i < 60'000; ++i) {
      if (std::filesystem::exists(log) && std::filesystem::file_size(log) > size) return child;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "it does not run";
    return child;
  }
  [[nodiscard]] std::string summary() const { return read_text_file(path("long/summary.json"), 1 << 24); }
};

const std::string endless = "[[arm.section]]\nlength = 1\n[[task]]\nkind = 'hold'\nduration = 19000\n";

TEST_F(StoppedProgram, EndsEarlyAndLeavesWhatItHas) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t child = running(endless, 1);
    kill(child, signal);
    const Ended ended = wait(child);
    EXPECT_EQ(ended.status, 128 + signal);
    EXPECT_THAT(ended.out, testing::StartsWith("results: long\noutcome: cancelled at "));
    const Node reported = parse_json(summary(), "summary");
    EXPECT_EQ(*reported.find("outcome")->as<std::string>(), "cancelled");
    const auto& reasons = *reported.find("reasons")->as<Node::Array>();
    ASSERT_EQ(reasons.size(), 1U);
    EXPECT_EQ(*reasons[0].as<std::string>(),
              fmt::format("the run was stopped at {:.6g} s", *reported.find("duration")->as<double>()));
    EXPECT_EQ(ended.err, "cancelled: " + *reasons[0].as<std::string>() + "\n");
    const McapReader log(path("long/log.mcap"));
    EXPECT_FALSE(log.truncated());
    EXPECT_THAT(std::string(log.messages().back().text()), HasSubstr("cancelled"));
    std::filesystem::remove_all(path("long"));
  }
}

TEST_F(StoppedProgram, BringsAnArmThatIsSteeredToRest) {
  const std::string task = "tolerance = 1e-9\ntimeout = 9000\n" + servo_target;
  const pid_t child = running("[record]\nreport = false\n" + servo_file(task), 100'000);
  kill(child, SIGINT);
  EXPECT_EQ(wait(child).status, 128 + SIGINT);
  const Node reported = parse_json(summary(), "summary");
  EXPECT_EQ(*reported.find("outcome")->as<std::string>(), "cancelled");
  EXPECT_EQ(reported.find("reasons")->as<Node::Array>()->size(), 1U) << "that it was stopped";
  EXPECT_THAT(summary(), HasSubstr("\"reason\": \"cancelled\""));
  const McapReader log(path("long/log.mcap"));
  EXPECT_FALSE(log.truncated());
  std::vector<ServoStep> steps;
  for (const McapMessage& message : log.messages())
    if (message.channel->topic == servo_steps_topic)
      steps.push_back(read_as<ServoStep>(parse_json(message.text(), "log")));
  ASSERT_GT(steps.size(), 3u);
  EXPECT_NE(steps[0].sent.bends, steps[2].sent.bends);
  const double rate = 90 * degree;
  // The limiter brings the arm to rest: no command jumps.
  for (std::size_t k = 1; k < steps.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT((steps[k].sent.bends[i] - steps[k - 1].sent.bends[i]).norm(), rate / 30 + 1e-9);
}

TEST_F(StoppedProgram, MakesNoFilmBeforeItEnds) {
  const std::filesystem::path filmer = path("ffmpeg");
  std::ofstream(filmer) << "#!/bin/sh\nexec cat >filmed\n";
  std::filesystem::permissions(filmer, std::filesystem::perms::owner_all);
  before_ = "PATH=" + folder_.path().string() + ":$PATH && ";
  const pid_t child = running(
      "[record]\ncameras = true\n[[arm.section]]\nlength = 1\n[[task]]\n"
      "kind = 'hold'\nduration = 3000\n",
      100'000);
  kill(child, SIGTERM);
  EXPECT_EQ(wait(child).status, 128 + SIGTERM);
  EXPECT_THAT(summary(), HasSubstr("\"outcome\": \"cancelled\""));
  EXPECT_FALSE(std::filesystem::exists(path("filmed")));
  EXPECT_FALSE(std::filesystem::exists(path("long/mp4")));
}

// A long motion of an arm whose model is a rod: its check takes far longer than a test.
std::string endless_check() {
  std::string text = "[record]\nreport = false\nscene = false\n[arm]\nkind = 'spatial'\nmodel = 'static'\n";
  for (int i = 0; i < 6; ++i)
    text += "[[arm.section]]\nlength = 0.1\nradius = 0.01\n[arm.section.material]\nyoungs_modulus = 1e6\n";
  for (int i = 1; i <= 6; ++i)
    for (const int angle : {0, 120, 240})
      text += fmt::format("[[arm.tendon]]\nsection = {}\nradius = 0.008\nangle_deg = {}\n", i, angle);
  return text + "[[task]]\nkind = 'move'\nduration = 9000\nto.bends = [" +
         "[0.5, 0], [0.5, 0], [0.5, 0], [0.5, 0], [0.5, 0], [0.5, 0]]\n";
}

TEST_F(StoppedProgram, StopsInTheCheckBeforeTheRun) {
  const pid_t child = running(endless_check(), 0);
  kill(child, SIGTERM);
  const Ended ended = wait(child);
  EXPECT_EQ(ended.status, 128 + SIGTERM);
  EXPECT_EQ(ended.err, "cancelled: the run was stopped at 0 s\n");
  EXPECT_THAT(summary(), HasSubstr("\"outcome\": \"cancelled\""));
  EXPECT_THAT(summary(), HasSubstr("cancelled: the motion is not completely checked"));
  EXPECT_FALSE(McapReader(path("long/log.mcap")).truncated());
  EXPECT_FALSE(std::filesystem::exists(path("long/commands.csv")));
}

TEST_F(StoppedProgram, StopsACheck) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::ofstream(path("long.toml")) << endless_check();
    const pid_t child = start("check long.toml", path("out"));
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    kill(child, signal);
    const Ended ended = wait(child);
    EXPECT_EQ(ended.status, 128 + signal);
    EXPECT_EQ(ended.out, "");
    // A signal that comes before the check begins ends the program without a word.
    EXPECT_THAT(ended.err, testing::AnyOf("", "cancelled: the check was stopped before it was complete\n"));
  }
}

// The first signal is pending while the run is stopped; the second one does not wait for it.
TEST_F(StoppedProgram, EndsAtOnceWhenItIsToldAgain) {
  const pid_t child = running(endless, 100'000);
  kill(child, SIGSTOP);
  kill(child, SIGTERM);
  kill(child, SIGCONT);
  kill(child, SIGINT);
  const int status = wait(child).status;
  EXPECT_TRUE(status == 128 + SIGTERM || status == 128 + SIGINT) << status;
  EXPECT_NO_THROW((void)McapReader(path("long/log.mcap")));
}

}  // namespace
}  // namespace flexura
