#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <string>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "tests/support/servo_bench.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

std::string complaint_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "x.toml";
  std::ofstream(file) << text;
  try {
    (void)load_experiment(file);
  } catch (const InputError& error) {
    const std::string all = error.what();
    EXPECT_NE(all.find("x.toml:"), std::string::npos) << all;
    return all;
  }
  return "";
}

std::string complaint(const std::string& task) { return complaint_of(servo_file(task)); }

TEST(BadServo, EachIsOneClearLine) {
  const std::string bends = "bends = [[0, 0], [0, 0], [0, 0]]";
  for (const auto& [task, words] : {
           std::pair<std::string, std::string>{"", "task[0].target: missing"},
           {"target = []\n", "empty array: expected an array of 1 to"},
           {"target = [{}]\n", "target[0]: has no shape: expected exactly one of bends"},
           {"target = [{" + bends + ", position = [0, 0, 1]}]\n", "in more than one way"},
           {"target = [{azimuths = [0, 1]}]\n", "different numbers of azimuths and elevations"},
           {"target = [{azimuths = [0, 1], elevations = [0]}]\n", "expected an array of 2 to"},
           {"target = [{curve = [[0, 0, 0], [0, 0, 0]]}]\n", "target[0].curve: has no length"},
           {"target = [{curve = [[0, 0, 0], [0, nan, 0]]}]\n", "nan"},
           {"target = [{curve = [[0, 0, 0], [0, 0.9, 0]]}]\n",
            "x.toml:32:12: task[0].target[0].curve: is 0.9 m long: expected the length of the arm within 5 "
            "%, 1 m"},
           {"target = [{pictures = [\"a.png\", \"b.png\"]}]\n",
            "task[0].target[0].pictures: no file \"a.png\""},
           {"target = [{pictures = [\"a.png\"]}]\n", "expected an array of 2"},
           {"target = [{pictures = [\"../a.png\", \"b.png\"]}]\n", "task[0].target[0].pictures: "},
           {fmt::format("target = [{{time = 1, {}}}, {{time = 1, {}}}]\n", bends, bends),
            "expected more than the time of the previous target"},
           {"law = \"pts\"\ntarget = [{" + bends + "}]\n", "expected one of \"shape\""},
           {"cameras = [\"front\", \"front\"]\ntarget = [{" + bends + "}]\n", "names one camera twice"},
           {"cameras = [\"front\", \"left\"]\ntarget = [{" + bends + "}]\n", "there is no camera \"left\""},
           {"tolerance = nan\ntarget = [{" + bends + "}]\n", "task[0].tolerance = nan"},
           {"rate = 0\ntarget = [{" + bends + "}]\n", "task[0].rate = 0: expected a number above 0"},
           {"target = [{bends = [[0, 0]]}]\n", "target[0]"},
           {"law = \"potential\"\ncameras = [\"side\", \"front\"]\ntarget = [{" + bends + "}]\n",
            "task[0].law: the law potential takes the picture of camera side as the plane XOY"},
           {"measure = \"flow\"\ntarget = [{" + bends + "}]\n",
            "task[0].measure: \"flow\" measures the angles of chords"},
           {"law = \"chords\"\nmeasure = \"flow\"\nanchor = 0\ntarget = [{" + bends + "}]\n",
            "task[0].anchor = 0: expected a number above 0"},
           {"settle = 5\ntimeout = 4\ntarget = [{" + bends + "}]\n",
            "task[0].timeout: 4 s: expected more than settle, 5 s"},
           {"target = [{curve = [[0, 0, 0], [0, 1e-300, 0]]}]\n", "target[0].curve: has no length"},
           {"give_up_after = 0.1\ntarget = [{" + bends + "}]\n",
            "task[0].give_up_after: 0.1 s: expected more than hold_after"},
           {"target = [{bends = [[0, 0], [0, 0], [0, 0], [0, 0]]}]\n",
            "4 given: expected 3 values, one per section"},
           {"target = [{" + bends + ", stretches = [1]}]\n", "1 given: expected 3 values, one per section"},
           {"target = [{" + bends + ", missed = 0.1}]\n", "target[0].missed: unknown key"},
           {"target = [{time = 1e300, " + bends + "}]\n", "expected a number from 0 s to 10000 s"},
           {"timeout = inf\ntarget = [{" + bends + "}]\n", "task[0].timeout = inf"},
           {"step = 1e-9\ntarget = [{" + bends + "}]\n",
            "task[0].step = 1e-09: expected a number from 0.0001 s"},
           {"step = 1e300\ntarget = [{" + bends + "}]\n", "task[0].step = 1e+300"},
           {"targets = 3\ntarget = [{" + bends + "}]\n", "did you mean \"target\""},
       }) {
    const std::string found = complaint(task);
    EXPECT_NE(found.find(words), std::string::npos) << task << " -> " << found;
  }
  EXPECT_EQ(complaint("target = [{" + bends + "}]\n"), "");
}

TEST(BadServo, KeysOfOlderVersionsAreGivenTheirNewNames) {
  const std::string bends = "bends = [[0, 0], [0, 0], [0, 0]]";
  const std::string old_keys =
      "blind_ms = 100\nlost = 2\ndoubt = { turn_deg = 1 }\ntarget = [{" + bends + "}]\n";
  const std::string found = complaint(old_keys);
  EXPECT_NE(found.find("task[0].blind_ms: is now called \"hold_after_ms\""), std::string::npos) << found;
  EXPECT_NE(found.find("task[0].lost: is now called \"give_up_after\""), std::string::npos) << found;
  EXPECT_NE(found.find("task[0].doubt: is now called \"camera_prior\""), std::string::npos) << found;
  EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 2) << found;
  const std::string inside = complaint("camera_prior = { turn_deg = 1 }\ntarget = [{" + bends + "}]\n");
  EXPECT_NE(inside.find("task[0].camera_prior.turn_deg: is now called \"rotation_std_deg\""),
            std::string::npos)
      << inside;
}

// Of the task's first line, once for both cameras.
TEST(BadServo, CamerasThatNoStepCanFollow) {
  struct Case {
    std::string rate, task, words;
  };
  for (const Case& bad :
       {Case{"1e-300", "", "task[0].step: missing, and the frame of the slower camera, 1e+300 s"},
        Case{"0.01", "", "100 s, cannot be used instead: expected a step from 0.0001 s to 10 s"},
        Case{"100000", "", "1e-05 s, cannot be used"}, Case{"0.01", "step = 0.05\n", ""}}) {
    std::string file = servo_file(bad.task + servo_target, {.sensor = "exposure = 1e-6"});
    for (std::size_t at = 0; (at = file.find("frame_rate = 30", at)) != std::string::npos; ++at)
      file.replace(at, 15, "frame_rate = " + bad.rate);
    const std::string found = complaint_of(file);
    EXPECT_NE(found.find(bad.words), std::string::npos) << found;
    EXPECT_EQ(found.empty(), bad.words.empty()) << found;
    EXPECT_LE(std::count(found.begin(), found.end(), '\n'), 0) << found;
  }
}

TEST(BadServo, PicturesThatComeAfterItIsGivenUp) {
  const auto late = [](const std::string& task, const std::string& delay) {
    return complaint_of(servo_file(task + servo_target, {.sensor = "exposure = 0.002, delay = " + delay}));
  };
  EXPECT_NE(
      late("", "100").find(
          "task[0].give_up_after: 3 s: expected more than the delay of 100.002 s of camera front's pictures"),
      std::string::npos)
      << late("", "100");
  EXPECT_NE(late("", "2.999"), "");
  EXPECT_EQ(late("", "2.99"), "");
  EXPECT_EQ(late("give_up_after = 40\n", "30"), "");
  EXPECT_NE(late("give_up_after = 100\n", "70").find("at most 60 s"), std::string::npos)
      << late("give_up_after = 100\n", "70");
  EXPECT_EQ(late("give_up_after = 100\n", "59"), "");
}

// Returns the error of a target whose two pictures are this file.
std::string complaint_of_pictures(const std::string& picture) {
  const TemporaryFolder folder;
  for (const char* name : {"a.pgm", "b.pgm"}) std::ofstream(folder.path() / name) << picture;
  const auto file = folder.path() / "x.toml";
  std::ofstream(file) << servo_file("target = [{pictures = [\"a.pgm\", \"b.pgm\"]}]\n");
  try {
    (void)load_experiment(file);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(BadServo, PicturesOfAnotherSizeOrDepth) {
  const std::string small = complaint_of_pictures("P2 2 2 255 1 2 3 4\n");
  EXPECT_NE(small.find("2 x 2 px: expected 320 x 240 px, the picture size of camera front"),
            std::string::npos)
      << small;
  std::string words = "P2 320 240 65535\n";
  for (int i = 0; i < 320 * 240; ++i) words += std::to_string(7 * i % 65536) + '\n';
  const std::string deep = complaint_of_pictures(words);
  EXPECT_NE(deep.find("16 bits per value: expected 8, as in the pictures of camera front"), std::string::npos)
      << deep;
}

}  // namespace
}  // namespace flexura
