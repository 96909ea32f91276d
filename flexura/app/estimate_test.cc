#include "flexura/app/estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/render.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/model/backbone.h"
#include "flexura/picture/image_file.h"
#include "flexura/sim/rig_config.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

constexpr const char* arm_text = R"([arm]
kind = "spatial"
initial = { bends = [[0.6, 0.4], [-1.0, 0.7], [0.9, -0.8]] }
[[arm.section]]
length = 0.35
radius = 0.018
[[arm.section]]
length = 0.35
radius = 0.018
[[arm.section]]
length = 0.3
radius = 0.018
[[camera]]
name = "front"
mount = { position = [0, 0.45, 1.9], look_at = [0, 0.45, 0] }
sensor = { psf = 0.7, full_well = 20000, read_noise = 1 }
[[camera]]
name = "side"
mount = { position = [-1.9, 0.45, 0], look_at = [0, 0.45, 0] }
sensor = { psf = 0.7, full_well = 20000, read_noise = 1 }
[[task]]
kind = "hold"
duration = 1
)";

constexpr const char* cameras_text = R"([[camera]]
name = "front"
fx = 800.0
cx = 319.5
cy = 239.5
position = [0.0, 0.45, 1.9]
rotation = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]
[[camera]]
name = "side"
fx = 800.0
cx = 319.5
cy = 239.5
position = [-1.9, 0.45, 0.0]
rotation = [[0, 0, 1], [0, -1, 0], [1, 0, 0]]
)";

// Pictures of the arm by both cameras, as a laboratory has them.
class Estimate : public testing::Test {
 protected:
  void SetUp() override {
    write_new_file(folder_.path() / "arm.toml", arm_text);
    write_new_file(folder_.path() / "cameras.toml", cameras_text);
    arguments_.cameras = (folder_.path() / "cameras.toml").string();
    arguments_.images = {photographed("arm", "front"), photographed("arm", "side")};
  }
  // A picture of what an experiment file shows.
  std::string photographed(const std::string& experiment, const std::string& camera) {
    const auto file = [&](const std::string& name) { return (folder_.path() / name).string(); };
    std::ostringstream out;
    RenderArguments render;
    render.experiment = file(experiment + ".toml");
    render.camera = camera;
    render.out = file(experiment + "_" + camera + ".png");
    EXPECT_EQ(render_command(render, out), exit_done);
    return render.out;
  }
  // The same arm with bands at these places, in colour.
  void write_banded(const std::string& name, const std::vector<std::string>& places) {
    std::string text = replaced(arm_text, "[[arm.section]]", "[arm.look]\nmarker = [");
    for (const std::string& place : places)
      text.insert(text.find("marker = [") + 10, "{ at = " + place + ", width = 0.02 }, ");
    text.insert(text.find("length = 0.35") - 1, "]\n[[arm.section]]");
    for (std::size_t at = 0; (at = text.find("psf =", at)) != std::string::npos; at += 30)
      text.insert(at, "pixels = \"color\", ");
    write_new_file(folder_.path() / (name + ".toml"), text);
  }
  // What the command prints.
  Node answer(int status) {
    std::ostringstream out;
    EXPECT_EQ(estimate_command(arguments_, out), status) << out.str();
    return parse_json(out.str(), "answer");
  }
  // The largest distance of the printed backbone from the arm's, at equal shares of their lengths, m.
  double error(const Node& answer) {
    const ArmSetup arm(load_experiment(folder_.path() / "arm.toml").model_rig());
    const Backbone truth(arm.arm, arm.initial);
    const auto& points = *answer.find("backbone")->as<Node::Array>();
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(points.size() - 1);
      const auto& p = *points[i].as<Node::Array>();
      const Eigen::Vector3d there(*p[0].as<double>(), *p[1].as<double>(), *p[2].as<double>());
      largest = std::max(largest, (there - truth.pose(share * truth.length()).position).norm());
    }
    return largest;
  }

  TemporaryFolder folder_;
  EstimateArguments arguments_;
};

TEST_F(Estimate, OfAKnownArmIsRightToATenthOfAMillimetreOrTwo) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 5e-4);
  EXPECT_LT(*found.find("rms_px")->as<double>(), 0.05);
  EXPECT_EQ(found.find("bends")->as<Node::Array>()->size(), 3u);
}

TEST_F(Estimate, OfAnUnknownArmNeedsNothingButTheCameras) {
  arguments_.base = {0, 0, 0};
  arguments_.length = 1;
  EXPECT_LT(error(answer(exit_done)), 4e-3);
  arguments_.length.reset();
  arguments_.base.clear();
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 1.5e-2);
  EXPECT_NEAR(*found.find("length")->as<double>(), 1, 0.015);
}

TEST_F(Estimate, UsesBandsOfWhichBothPicturesShowTheSame) {
  const std::vector<std::string> places = {"0.15", "0.3", "0.45", "0.6", "0.75", "0.9"};
  arguments_.base = {0, 0, 0};
  arguments_.length = 1;
  write_banded("banded", places);
  arguments_.images = {photographed("banded", "front"), photographed("banded", "side")};
  const Node found = answer(exit_done);
  ASSERT_NE(found.find("markers"), nullptr) << write_json(found);
  const auto& markers = *found.find("markers")->as<Node::Array>();
  ASSERT_EQ(markers.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(*markers[i].find("s")->as<double>(), std::stod(places[i]), 1.5e-3);
    EXPECT_EQ(*markers[i].find("images")->as<std::int64_t>(), 2);
  }
  EXPECT_LT(error(found), 4e-3);
  arguments_.markers = {"15%", "0.3", "0.45", "60%", "0.75", "0.9"};
  EXPECT_LT(error(answer(exit_done)), 4e-3);
  // One is hidden from the second camera, which sees another where none is.
  write_banded("false", {"0.15", "0.3", "0.45", "0.67", "0.75", "0.9"});
  arguments_.images[1] = photographed("false", "side");
  const Node doubtful = answer(exit_done);
  EXPECT_LT(error(doubtful), 5e-3);
  EXPECT_EQ(doubtful.find("markers")->as<Node::Array>()->size(), places.size());
  arguments_.markers.clear();
  EXPECT_LT(error(answer(exit_done)), 5e-3);
}

// The second camera is turned by half a degree and believed not to be.
TEST_F(Estimate, FindsWhatIsWrongWithACameraThatIsDoubted) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const std::string turned =
      "rotation = [[0.0087265, 0, 0.99996192], [0, -1, 0], [0.99996192, 0, -0.0087265]]";
  const std::string wrong = replaced(cameras_text, "rotation = [[0, 0, 1], [0, -1, 0], [1, 0, 0]]", turned);
  arguments_.cameras = (folder_.path() / "wrong.toml").string();
  write_new_file(arguments_.cameras, wrong);
  EXPECT_NE(answer(exit_done).find("notes"), nullptr);
  EXPECT_GT(error(answer(exit_done)), 5e-3);
  arguments_.cameras = (folder_.path() / "doubted.toml").string();
  write_new_file(arguments_.cameras, replaced(wrong, "name = \"side\"",
                                              "name = \"side\"\ndoubt = { turn_deg = 1, focal = 0.01 }"));
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 1.5e-3);
  const auto& images = *found.find("images")->as<Node::Array>();
  EXPECT_EQ(images[0].find("camera_error"), nullptr);
  const auto& turn = *images[1].find("camera_error")->find("turn")->as<Node::Array>();
  EXPECT_NEAR(*turn[1].as<double>(), 0.0087265, 5e-4);
}

TEST_F(Estimate, SaysWhyThereIsNone) {
  arguments_.images[1] = (folder_.path() / "blank.png").string();
  write_new_file(arguments_.images[1], png(Image<std::uint8_t>(64, 48)));
  const Node found = answer(exit_missed);
  EXPECT_NE(found.find("reason"), nullptr);
  EXPECT_EQ(found.find("backbone"), nullptr);
}

// A hair over one picture, and a second arm, smaller, in the other.
TEST_F(Estimate, IsNotMisledByAHairOrASecondArm) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const auto changed = [&](std::size_t i, const std::string& name, const auto& change) {
    const std::string file = read_text_file(arguments_.images[i], most_picture_bytes);
    Image<std::uint8_t> picture =
        decode_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, name).bytes;
    change(picture);
    arguments_.images[i] = (folder_.path() / name).string();
    write_new_file(arguments_.images[i], png(picture));
  };
  const auto darken = [](Image<std::uint8_t>& picture, int u, int v) {
    for (int c = 0; c < picture.channels(); ++c)
      picture.at(u, v, c) = std::min<std::uint8_t>(picture.at(u, v, c), 25);
  };
  changed(0, "hair.png", [&](Image<std::uint8_t>& picture) {
    for (int u = 0; u < picture.width(); ++u)
      for (int k = 0; k < 2; ++k) darken(picture, u, 200 + u / 11 + k);
  });
  EXPECT_LT(error(answer(exit_done)), 1e-3);
  changed(1, "two.png", [&](Image<std::uint8_t>& picture) {
    for (int v = 60; v < 200; ++v)
      for (int u = 560; u < 574; ++u) darken(picture, u, v);
  });
  EXPECT_LT(error(answer(exit_done)), 1e-3);
}

TEST_F(Estimate, SaysThatTheBaseIsGuessed) {
  const auto says = [&] {
    const Node found = answer(exit_done);
    const Node* notes = found.find("notes");
    return notes != nullptr && write_json(*notes).find("--base tells") != std::string::npos;
  };
  EXPECT_TRUE(says());
  arguments_.base = {0, 0, 0};
  EXPECT_FALSE(says());
}

TEST_F(Estimate, DoubtsPicturesOfTheOtherCameraAndNoneElse) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const Node right = answer(exit_done);
  EXPECT_EQ(right.find("notes"), nullptr) << write_json(right);
  std::swap(arguments_.images[0], arguments_.images[1]);
  std::ostringstream out;
  const int status = estimate_command(arguments_, out);
  const Node wrong = parse_json(out.str(), "answer");
  EXPECT_NE(wrong.find(status == exit_done ? "notes" : "reason"), nullptr) << out.str();
}

TEST_F(Estimate, RefusesWhatItCannotUse) {
  std::ostringstream out;
  EstimateArguments bad = arguments_;
  bad.images.pop_back();
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.images.push_back(bad.images.front());
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.length = -1;
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.base = {0, NAN, 0};
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad.base = {1e300, 0, 0};
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.length = 1e300;
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.cameras = (folder_.path() / "far.toml").string();
  write_new_file(bad.cameras, replaced(cameras_text, "position = [", "position = [1e200, 0, 0]\n# ["));
  EXPECT_THROW(estimate_command(bad, out), InputError);
  for (const char* marker : {"x", "", "12%%", "0.3", "130%", "-1%", "nan%"}) {
    bad = arguments_;
    bad.markers = {marker};
    EXPECT_THROW(estimate_command(bad, out), InputError) << marker;
  }
  bad = arguments_;
  bad.images[0] = (folder_.path() / "cameras.toml").string();
  EXPECT_THROW(estimate_command(bad, out), InputError);
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace flexura
