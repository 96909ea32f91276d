#include "flexura/log/export_mp4.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/log/results.h"
#include "flexura/store/text_file.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr const char* two_cameras = R"(
[record]
cameras = true
report = false
[arm]
[[arm.section]]
length = 1
[[camera]]
name = "one"
mount = {{ position = [0, 0.5, 3], look_at = [0, 0.5, 0] }}
sensor = {{ width = 8, height = 8, frame_rate = {0}, {1} }}
[[camera]]
name = "other"
mount = {{ position = [0, 0.5, 3], look_at = [0, 0.5, 0] }}
sensor = {{ width = 8, height = 8, frame_rate = {0}, {2} }}
[[task]]
kind = "move"
to = {{ archings = [0.5] }}
)";

// Films made by a program named ffmpeg that writes its arguments and its input.
class ExportMp4 : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto program = folder_.path() / film_program;
    std::ofstream(program)
        << "#!/bin/sh\nfor file; do :; done\necho \"$@\" > \"$file.arguments\"\ncat > \"$file\"\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    path_ = std::getenv("PATH");
    ASSERT_EQ(setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1), 0);
  }
  void TearDown() override { setenv("PATH", path_.c_str(), 1); }

  void film(double rate, const std::string& one, const std::string& other = "bits = 8") {
    run(fmt::format(two_cameras, rate, one, other));
    films_ = exported().folder;
  }
  void run(const std::string& text) {
    std::filesystem::create_directory(results());
    Quiet progress;
    (void)run_experiment(parse_experiment(text, "x.toml"), results(), progress);
  }
  [[nodiscard]] ExportResult exported() const {
    return export_mp4(results(), load_experiment(results() / experiment_file_name).true_rig().cameras);
  }
  [[nodiscard]] std::filesystem::path results() const { return folder_.path() / "run"; }
  [[nodiscard]] std::string file(const std::string& name) const {
    return read_text_file(films_ / name, 1 << 24);
  }
  [[nodiscard]] int frames(const std::string& name) const {
    const std::string bytes = file(name), start = "\x89PNG";
    int count = 0;
    for (std::size_t at = bytes.find(start); at != std::string::npos; at = bytes.find(start, at + 1)) ++count;
    return count;
  }
  TemporaryFolder folder_;
  std::filesystem::path films_;
  std::string path_;
};

TEST_F(ExportMp4, FillsWhatWasLostAtBothEndsToo) {
  film(20, "drop = 0.8", "delay = 0.07");
  EXPECT_EQ(frames("one.mp4"), 21);
  EXPECT_EQ(frames("other.mp4"), 21);
}

TEST_F(ExportMp4, HasTheCamerasFrameRateHoweverManyFramesThereAre) {
  film(0.25, "bits = 8");
  EXPECT_EQ(frames("one.mp4"), 1);
  EXPECT_THAT(file("one.mp4.arguments"), HasSubstr("-framerate 0.25 "));
}

TEST_F(ExportMp4, SaysWhenNoFrameArrived) {
  run(fmt::format(two_cameras, 20, "drop = 1", "delay = 2"));
  try {
    (void)exported();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("at least one frame arrived"));
  }
}

}  // namespace
}  // namespace flexura
