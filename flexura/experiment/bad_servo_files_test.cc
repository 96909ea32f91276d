#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "tests/support/servo_bench.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

std::string complaint(const std::string& task) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "x.toml";
  std::ofstream(file) << servo_file(task);
  try {
    (void)load_experiment(file);
  } catch (const InputError& error) {
    const std::string all = error.what();
    EXPECT_NE(all.find("x.toml:"), std::string::npos) << all;
    return all;
  }
  return "";
}

TEST(BadServo, EachIsOneClearLine) {
  const std::string bends = "bends = [[0, 0], [0, 0], [0, 0]]";
  for (const auto& [task, words] : {
           std::pair<std::string, std::string>{"", "task[0].target: missing"},
           {"target = []\n", "empty array: expected an array of 1 to"},
           {"target = [{}]\n", "target[0]: says nothing: expected a shape in one way"},
           {"target = [{" + bends + ", position = [0, 0, 1]}]\n", "in more than one way"},
           {"target = [{azimuths = [0, 1]}]\n", "azimuths and elevations that do not belong together"},
           {"target = [{azimuths = [0, 1], elevations = [0]}]\n", "expected an array of 2 to"},
           {"target = [{curve = [[0, 0, 0], [0, 0, 0]]}]\n", "target[0].curve: has no length"},
           {"target = [{curve = [[0, 0, 0], [0, nan, 0]]}]\n", "nan"},
           {"target = [{pictures = [\"a.png\", \"b.png\"]}]\n",
            "task[0].target[0].pictures: no file \"a.png\""},
           {"target = [{pictures = [\"a.png\"]}]\n", "expected an array of 2"},
           {"target = [{pictures = [\"../a.png\", \"b.png\"]}]\n", "task[0].target[0].pictures: "},
           {fmt::format("target = [{{time = 1, {}}}, {{time = 1, {}}}]\n", bends, bends),
            "expected more than the target before it"},
           {"law = \"pts\"\ntarget = [{" + bends + "}]\n", "expected one of \"shape\""},
           {"cameras = [\"front\", \"front\"]\ntarget = [{" + bends + "}]\n", "names one camera twice"},
           {"cameras = [\"front\", \"left\"]\ntarget = [{" + bends + "}]\n", "there is no camera \"left\""},
           {"tolerance = nan\ntarget = [{" + bends + "}]\n", "task[0].tolerance = nan"},
           {"rate = 0\ntarget = [{" + bends + "}]\n", "task[0].rate = 0: expected a number above 0"},
           {"target = [{bends = [[0, 0]]}]\n", "target[0]"},
           {"law = \"potential\"\ncameras = [\"side\", \"front\"]\ntarget = [{" + bends + "}]\n",
            "task[0].law: \"potential\" reads camera side as the plane XOY"},
           {"measure = \"flow\"\ntarget = [{" + bends + "}]\n",
            "task[0].measure: \"flow\" carries the angles of chords"},
           {"law = \"chords\"\nmeasure = \"flow\"\nanchor = 0\ntarget = [{" + bends + "}]\n",
            "task[0].anchor = 0: expected a number above 0"},
           {"settle = 5\ntimeout = 4\ntarget = [{" + bends + "}]\n",
            "task[0].timeout: 4 s: expected more than settle, 5 s"},
           {"target = [{curve = [[0, 0, 0], [0, 1e-300, 0]]}]\n", "target[0].curve: has no length"},
           {"lost = 0.1\ntarget = [{" + bends + "}]\n", "task[0].lost: 0.1 s: expected more than blind"},
           {"targets = 3\ntarget = [{" + bends + "}]\n", "did you mean \"target\""},
       }) {
    const std::string found = complaint(task);
    EXPECT_NE(found.find(words), std::string::npos) << task << " -> " << found;
  }
  EXPECT_EQ(complaint("target = [{" + bends + "}]\n"), "");
}

// What is wrong with a target of two pictures that are this file.
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
  EXPECT_NE(small.find("2 x 2 px: expected 320 x 240, as camera front takes them"), std::string::npos)
      << small;
  std::string words = "P2 320 240 65535\n";
  for (int i = 0; i < 320 * 240; ++i) words += std::to_string(7 * i % 65536) + '\n';
  const std::string deep = complaint_of_pictures(words);
  EXPECT_NE(deep.find("16 bits a value: expected 8, as camera front takes them"), std::string::npos) << deep;
}

}  // namespace
}  // namespace flexura
