#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/estimate.h"
#include "flexura/app/render.h"
#include "flexura/base/bytes.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/experiment/experiment.h"
#include "flexura/model/backbone.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/rig_config.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/camera_files.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {

inline constexpr const char* photographed_arm = R"([arm]
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

/// Pictures of the arm by both cameras, as taken in a laboratory.
class EstimateBench : public testing::Test {
 protected:
  void SetUp() override {
    write_new_file(folder_.path() / "arm.toml", photographed_arm);
    write_new_file(folder_.path() / "cameras.toml", two_measured_cameras);
    arguments_.cameras = (folder_.path() / "cameras.toml").string();
    arguments_.images = {photographed("arm", "front"), photographed("arm", "side")};
  }
  static Image<std::uint8_t> picture_of(const std::string& name) {
    const std::string file = read_text_file(name, most_picture_bytes);
    return decode_picture(bytes_of(file), name).bytes;
  }
  /// Renders a picture of an experiment file's scene. Each file is rendered once for all tests.
  std::string photographed(const std::string& experiment, const std::string& camera) {
    static std::map<std::string, std::string> drawn;
    const auto file = [&](const std::string& name) { return (folder_.path() / name).string(); };
    std::string& png = drawn[camera + read_text_file(file(experiment + ".toml"), most_picture_bytes)];
    const std::string name = file(experiment + "_" + camera + ".png");
    if (!png.empty()) {
      replace_file(name, png);
      return name;
    }
    std::ostringstream out;
    RenderArguments render;
    render.experiment = file(experiment + ".toml");
    render.camera = camera;
    render.out = name;
    EXPECT_EQ(render_command(render, out), exit_done);
    png = read_text_file(name, most_picture_bytes);
    return name;
  }
  /// Writes the same arm with coloured bands at these places.
  void write_banded(const std::string& name, const std::vector<std::string>& places) {
    std::string text = replaced(photographed_arm, "[[arm.section]]", "[arm.look]\nmarker = [");
    for (const std::string& place : places)
      text.insert(text.find("marker = [") + 10, "{ at = " + place + ", width = 0.02 }, ");
    text.insert(text.find("length = 0.35") - 1, "]\n[[arm.section]]");
    for (std::size_t at = 0; (at = text.find("psf =", at)) != std::string::npos; at += 30)
      text.insert(at, "pixels = \"color\", ");
    write_new_file(folder_.path() / (name + ".toml"), text);
  }
  /// Returns the JSON output of the command.
  Node answer(int status) {
    std::ostringstream out;
    EXPECT_EQ(estimate_command(arguments_, out), status) << out.str();
    return parse_json(out.str(), "answer");
  }
  /// Returns the largest distance between printed and true backbone at equal shares of their lengths, m.
  double error(const Node& answer, const std::string& experiment = "arm") {
    const RigConfig rig = load_experiment(folder_.path() / (experiment + ".toml")).model_rig();
    const Backbone truth = rig.arm.model().backbone(ArmSetup(rig).initial);
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

}  // namespace flexura
