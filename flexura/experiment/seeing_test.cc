// The tables [[seeing]] and [[backdrop]] of experiment files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <variant>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/picture/image_file.h"
#include "flexura/rig/filming.h"
#include "flexura/rig/seeing_config.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/arm_scene.h"
#include "tests/support/drawn_scenes.h"
#include "tests/support/quiet.h"
#include "tests/support/servo_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::HasSubstr;

// A file with these additional lines, two color cameras and pictures of 320 x 240 px beside it.
class Seeing : public testing::Test {
 protected:
  Seeing() {
    const DrawnTexture texture(3, 30);
    DrawnScene scene(320, 240, 3), small(32, 24, 3);
    scene.ground([&](int u, int v, int c) { return 40 + 180 * texture(u + 50 * c, v); });
    clutter_ = scene.photograph(0, 1);
    write_new_file(folder_.path() / "clutter.png", png(clutter_));
    write_new_file(folder_.path() / "small.png", png(small.photograph(0, 1)));
    write_new_file(folder_.path() / "none.png", "no picture");
  }
  Experiment load(const std::string& lines, const std::string& pixels = "\"color\"") {
    ServoSetup rig;
    rig.sensor = "read_noise = 0, pixels = " + pixels;
    rig.rest = "[stand]\nscreen = []\n" + lines;
    const auto file = folder_.path() / "x.toml";
    std::ofstream(file) << servo_file("track = \"model\"\n" + servo_target, rig);
    return load_experiment(file);
  }
  std::string complaint(const std::string& lines, const std::string& pixels = "\"color\"") {
    try {
      (void)load(lines, pixels);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
  Image<std::uint8_t> clutter_;
};

TEST_F(Seeing, IsReadForItsCamera) {
  const Experiment experiment = load(
      "[[seeing]]\ncamera = \"side\"\nregion = [[10, 20], [300, 200]]\nbackground = \"clutter.png\"\ncolor = "
      "[30, 40, 50]\n");
  const auto scenes = arm_scenes(experiment);
  ASSERT_EQ(scenes.size(), 2U);
  EXPECT_EQ(scenes[0], nullptr);
  ASSERT_NE(scenes[1], nullptr);
  ASSERT_EQ(scenes[1]->region.size(), 4U);
  EXPECT_EQ(scenes[1]->region[1], Eigen::Vector2d(300, 20));
  EXPECT_EQ(scenes[1]->background, clutter_);
  EXPECT_EQ(*scenes[1]->color, Eigen::Vector3d(30, 40, 50));
}

TEST_F(Seeing, ErrorsAreOneClearLine) {
  for (const auto& [lines, words] : {
           std::pair<std::string, std::string>{"[[seeing]]\n", "seeing[0].camera: missing"},
           {"[[seeing]]\ncamera = \"top\"\n", "seeing[0].camera: \"top\" is no camera"},
           {"[[seeing]]\ncamera = \"side\"\n[[seeing]]\ncamera = \"side\"\n",
            "seeing[1].camera: \"side\" is given twice"},
           {"[[seeing]]\ncamera = \"side\"\nregion = [[1, 2]]\n", "seeing[0].region: has one corner"},
           {"[[seeing]]\ncamera = \"side\"\nregion = [[1, 2], [3, nan]]\n", "nan"},
           {"[[seeing]]\ncamera = \"side\"\ncolor = [1, 2, 256]\n", "seeing[0].color"},
           {"[[seeing]]\ncamera = \"side\"\nbackground = \"missing.png\"\n",
            "seeing[0].background: no file \"missing.png\""},
           {"[[seeing]]\ncamera = \"side\"\nbackground = \"../x.png\"\n", "seeing[0].background: "},
           {"[[seeing]]\ncamera = \"side\"\nbackground = \"small.png\"\n",
            "32 x 24 px: expected 320 x 240 px, the picture size of camera side"},
           {"[[seeing]]\ncamera = \"side\"\nbackground = \"none.png\"\n", "seeing[0].background: "},
           {"[[backdrop]]\ncamera = \"side\"\n", "backdrop[0].picture: missing"},
           {"[[backdrop]]\ncamera = \"side\"\npicture = \"small.png\"\n", "backdrop[0].picture: "},
       }) {
    const std::string said = complaint(lines);
    EXPECT_THAT(said, HasSubstr(words)) << lines;
    EXPECT_THAT(said, HasSubstr("x.toml:")) << lines;
  }
  EXPECT_THAT(complaint("[[seeing]]\ncamera = \"side\"\ncolor = [1, 2, 3]\n", "\"gray\""),
              HasSubstr("camera side takes gray pictures"));
}

TEST_F(Seeing, ABackdropIsBehindTheArm) {
  const Experiment experiment = load("[[backdrop]]\ncamera = \"front\"\npicture = \"clutter.png\"\n");
  const Image<float> light = backdrop_light(experiment, 0);
  ASSERT_EQ(light.width(), 320);
  EXPECT_NEAR(light.at(5, 7, 1), clutter_.at(5, 7, 1) / 255.0, 1e-6);
  EXPECT_TRUE(backdrop_light(experiment, 1).values().empty());
  Filming filming(experiment, 1);
  const auto picture = std::get<Image<std::uint8_t>>(filming.take(filming.shot(0, 0)));
  // Left of the arm, the camera sees the clutter, up to its blur.
  double difference = 0;
  for (int v = 5; v < 235; ++v)
    for (int u = 5; u < 100; ++u) difference += std::abs(picture.at(u, v, 0) - clutter_.at(u, v, 0));
  EXPECT_LT(difference / (95 * 230), 2);
  // The straight arm is in the middle.
  for (int c = 0; c < 3; ++c) EXPECT_LT(picture.at(160, 120, c), 90);
  const auto other = std::get<Image<std::uint8_t>>(filming.take(filming.shot(1, 0)));
  EXPECT_LT(other.at(20, 20, 0), 20) << "nothing is there";
}

TEST_F(Seeing, ResultsHaveCopiesOfTheFiles) {
  std::filesystem::create_directory(folder_.path() / "rooms");
  write_new_file(folder_.path() / "rooms/empty.png", png(clutter_));
  const auto file = folder_.path() / "x.toml";
  ServoSetup rig;
  rig.rest =
      "[[backdrop]]\ncamera = \"front\"\npicture = \"clutter.png\"\n[[seeing]]\ncamera = \"side\"\n"
      "background = \"rooms/empty.png\"\n[record]\nreport = false\n";
  const std::string text = servo_file(servo_target, rig);
  std::ofstream(file) << text.substr(0, text.find("[[task]]"))
                      << "[[task]]\nkind = \"hold\"\nduration = 0.1\n";
  const TemporaryFolder results;
  Quiet quiet;
  const RunResult run = run_experiment(load_experiment(file), results.path(), quiet);
  EXPECT_EQ(run.outcome, RunOutcome::done);
  const Experiment again = load_experiment(results.path() / experiment_file_name);
  EXPECT_EQ(arm_scenes(again)[1]->background, clutter_);
  EXPECT_FALSE(backdrop_light(again, 0).values().empty());
}

}  // namespace
}  // namespace flexura
