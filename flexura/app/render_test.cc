#include "flexura/app/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "flexura/picture/image_file.h"
#include "flexura/rig/filming.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

class Render : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_.path() / "x.toml") << R"(
[arm]
kind = "spatial"
look = { bands = { per_section = 2 } }
[[arm.section]]
length = 1
[[camera]]
name = "front"
mount = { position = [0, 0.5, 3], look_at = [0, 0.5, 0] }
lens = { fx = 100 }
sensor = { width = 80, height = 60 }
[truth.arm.base]
position = [0.2, 0, 0]
[[task]]
kind = "move"
to = { bends = [[0.5, 0.5]] }
)";
  }
  [[nodiscard]] RenderArguments arguments(const char* out) const {
    RenderArguments arguments;
    arguments.experiment = (folder_.path() / "x.toml").string();
    arguments.camera = "front";
    arguments.time = 0.5;
    arguments.out = (folder_.path() / out).string();
    return arguments;
  }
  std::string file(const char* name) { return read_text_file(folder_.path() / name, 1 << 24); }
  // Returns the error's text.
  static std::string error_of(const RenderArguments& arguments) {
    std::ostringstream out;
    try {
      render_command(arguments, out);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  TemporaryFolder folder_;
};

TEST_F(Render, WritesTheSameImageTwiceAndReplacesIt) {
  std::ostringstream out;
  EXPECT_EQ(render_command(arguments("a.png"), out), 0);
  const std::string first = file("a.png");
  EXPECT_THAT(first, ::testing::StartsWith("\x89PNG"));
  render_command(arguments("a.png"), out);
  EXPECT_EQ(file("a.png"), first);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.png.new"));
}

TEST_F(Render, ShowsTheTruthUnlessAskedForTheModel) {
  std::ostringstream out;
  render_command(arguments("true.png"), out);
  RenderArguments model = arguments("model.png");
  model.model = true;
  render_command(model, out);
  RenderArguments plain = arguments("plain.png");
  plain.sets = {"truth.arm.base.position=[0, 0, 0]"};
  render_command(plain, out);
  EXPECT_NE(file("true.png"), file("model.png"));
  EXPECT_EQ(file("plain.png"), file("model.png"));
}

TEST_F(Render, WritesWhatIsTrueBesideIt) {
  std::ostringstream out;
  RenderArguments asked = arguments("b.png");
  asked.truth = true;
  render_command(asked, out);
  for (const char* name : {"b_depth.tiff", "b_s.tiff", "b_labels.png", "b_flow.tiff"})
    EXPECT_FALSE(file(name).empty()) << name;
  const Node truth = parse_json(file("b_truth.json"), "truth");
  EXPECT_EQ(truth.find("axis")->as<Node::Array>()->size(), 201U);
  EXPECT_EQ(truth.find("markers")->as<Node::Array>()->size(), 2U);
  EXPECT_GE(truth.find("outlines")->as<Node::Array>()->size(), 3U);
  // The base is where [truth] has it: 0.2 m to the right at a depth of 3 m.
  const Node& base = truth.find("axis")->as<Node::Array>()->front();
  const auto& pixel = *base.find("pixel")->as<Node::Array>();
  EXPECT_NEAR(*pixel[0].as<double>(), 39.5 + 100 * 0.2 / 3, 1e-9);
  EXPECT_NEAR(*pixel[1].as<double>(), 29.5 + 100 * 0.5 / 3, 1e-9);
  EXPECT_NEAR(*base.find("depth")->as<double>(), 3, 1e-12);
}

// Returns the frames of an experiment's run as image files.
std::vector<std::string> filmed(const std::filesystem::path& file) {
  const Experiment experiment = load_experiment(file);
  const Schedule schedule(experiment);
  Filming filming(experiment);
  std::vector<std::string> images;
  const auto take = [&](const FilmedFrame& filmed) {
    images.push_back(std::visit([](const auto& image) { return png(image); }, *filmed.frame.picture));
  };
  for (std::size_t step = 0; step <= schedule.steps(); ++step) {
    const double time = schedule.time_of_step(step);
    filming.play_to(time, schedule.state_at(time), take);
  }
  return images;
}

TEST_F(Render, IsTheFrameThatARunFilms) {
  const std::string plain = file("x.toml");
  for (const std::string truth :
       {"", "[truth.arm.initial]\nbends = [[-0.6, 0]]\n", "[[truth.arm.section]]\nmax_bend_rate = 0.4\n"}) {
    SCOPED_TRACE(truth);
    std::ofstream(folder_.path() / "x.toml")
        << replaced(plain, "height = 60 }", "height = 60, frame_rate = 10, exposure = 0.05, read_noise = 2 }")
        << truth;
    std::ostringstream out;
    const std::vector<std::string> frames = filmed(folder_.path() / "x.toml");
    ASSERT_EQ(frames.size(), 10U);
    for (const std::size_t number : {0U, 4U, 8U}) {
      RenderArguments asked = arguments("f.png");
      asked.time = static_cast<double>(number) / 10;
      render_command(asked, out);
      EXPECT_TRUE(file("f.png") == frames[number]) << number;
    }
  }
}

TEST_F(Render, ItsTruthIsThatOfTheMiddleOfTheExposure) {
  const auto bend = [&](const char* exposure, double time) {
    std::ostringstream out;
    RenderArguments asked = arguments("t.png");
    asked.truth = true;
    asked.time = time;
    asked.sets = {"camera.0.sensor.frame_rate=4", std::string("camera.0.sensor.exposure=") + exposure};
    render_command(asked, out);
    const Node truth = parse_json(file("t_truth.json"), "truth");
    const auto& pixel = *truth.find("axis")->as<Node::Array>()->back().find("pixel")->as<Node::Array>();
    return Eigen::Vector2d(*pixel[0].as<double>(), *pixel[1].as<double>());
  };
  EXPECT_LE((bend("0.2", 0.4) - bend("0.0", 0.5)).norm(), 1e-6);
  EXPECT_GT((bend("0.2", 0.4) - bend("0.0", 0.4)).norm(), 0.5);
}

TEST_F(Render, TellsWhatItIsNotGiven) {
  RenderArguments bad = arguments("c.png");
  bad.camera = "top";
  EXPECT_THAT(error_of(bad), HasSubstr("there is no camera \"top\": expected one of \"front\""));
  for (const double time : {-0.1, 1.1, std::nan("")}) {
    bad = arguments("c.png");
    bad.time = time;
    EXPECT_THAT(error_of(bad), HasSubstr("expected 0 to 1 s")) << time;
  }
  EXPECT_THAT(error_of(arguments("c.jpg")), HasSubstr("expected a file name that ends in .png"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "c.png"));
}

}  // namespace
}  // namespace flexura
