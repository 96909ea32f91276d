// Calibrations of wide lenses by the program, from pictures of a board.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/intrinsics.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/board/board_target.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"
#include "tests/support/boards.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::HasSubstr;

const BoardTarget small_board{.columns = 6, .rows = 5, .square = 0.03};

// The rays of a lens through the corners of its pixels; those between are interpolated.
class PixelRays {
 public:
  PixelRays(const Lens& lens, int width, int height) : columns_(width + 1) {
    for (int v = 0; v <= height; ++v)
      for (int u = 0; u <= width; ++u)
        rays_.push_back(lens.unproject({u - 0.5, v - 0.5}).value().homogeneous().normalized());
  }
  // `across` and `down`: place in the pixel, from 0 to 1.
  [[nodiscard]] Eigen::Vector3d at(int u, int v, double across, double down) const {
    const auto corner = [&](int i, int j) {
      return rays_[static_cast<std::size_t>((v + j) * columns_ + u + i)];
    };
    return (1 - down) * ((1 - across) * corner(0, 0) + across * corner(1, 0)) +
           down * ((1 - across) * corner(0, 1) + across * corner(1, 1));
  }

 private:
  int columns_;
  std::vector<Eigen::Vector3d> rays_;
};

Image<std::uint8_t> seen_through(const PixelRays& rays, const Pose& X_CB, int width, int height) {
  Image<std::uint8_t> picture(width, height);
  const Pose X_BC = X_CB.inverse();
  constexpr int side = 4;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      int dark = 0;
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          const Eigen::Vector3d ray =
              X_BC.rotation * rays.at(u, v, (i + (j + 0.5) / side) / side, (j + (i + 0.5) / side) / side);
          const Eigen::Vector3d at = X_BC.position - X_BC.position.z() / ray.z() * ray;
          const bool is_ahead = X_BC.position.z() * ray.z() < 0;
          dark += is_ahead && is_dark(small_board, at.head<2>() / small_board.square) ? 1 : 0;
        }
      }
      picture.at(u, v) = static_cast<std::uint8_t>(225 - 195 * dark / (side * side));
    }
  }
  return picture;
}

// Pictures of a board by a fisheye lens.
class WideLens : public testing::Test {
 protected:
  static constexpr int width = 240, height = 180;
  const Intrinsics truth_{
      .fx = 100, .fy = 100, .cx = 120.5, .cy = 88.5, .distortion = {0.03, -0.01, 0.0, 0.0}};

  void SetUp() override {
    arguments_.board = "6x5";
    arguments_.square = small_board.square;
    const Lens lens(truth_);
    const PixelRays rays(lens, width, height);
    TestRandom random(5);
    constexpr std::size_t count = 8;
    while (arguments_.images.size() < count) {
      const Pose X_CB = random_board(random, small_board, 0.14, 0.5, 0.7);
      // With the squares around the corners.
      const auto is_shown = [&](double x, double y) {
        const auto pixel = lens.project(X_CB * (small_board.square * Eigen::Vector3d(x, y, 0)));
        return pixel && pixel->x() > 4 && pixel->y() > 4 && pixel->x() < width - 5 && pixel->y() < height - 5;
      };
      bool is_whole = true;
      for (const double x : {-1.3, 2.5, 6.3})
        for (const double y : {-1.3, 2.0, 5.3}) is_whole = is_whole && is_shown(x, y);
      if (!is_whole) continue;
      const std::string file = path(fmt::format("board{}.png", arguments_.images.size()));
      write_new_file(file, png(seen_through(rays, X_CB, width, height)));
      arguments_.images.push_back(file);
    }
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string run(int status) {
    std::ostringstream out, err;
    EXPECT_EQ(intrinsics_command(arguments_, out, err), status) << out.str();
    return out.str();
  }
  std::string refusal() {
    try {
      (void)run(exit_done);
    } catch (const InputError& error) {
      return error.what();
    }
    return "not refused";
  }

  TemporaryFolder folder_;
  IntrinsicsArguments arguments_;
};

TEST_F(WideLens, IsFoundAmongTheModelsAndWritten) {
  arguments_.lens = "best";
  arguments_.out = path("cameras.toml"), arguments_.rig = path("rig.toml");
  const std::string table = run(exit_done);
  EXPECT_THAT(table, HasSubstr("lens model fisheye: rms "));
  EXPECT_THAT(table, HasSubstr("px, explains the pictures best\n"));
  arguments_.json = true;
  const Node answer = parse_json(run(exit_done), "answer");
  const auto& models = *answer.find("models")->as<Node::Array>();
  ASSERT_EQ(models.size(), 3U);
  EXPECT_EQ(*models[2].find("chosen")->as<bool>(), true);
  const Node& camera = answer.find("cameras")->as<Node::Array>()->front();
  EXPECT_EQ(*camera.find("model")->as<std::string>(), "fisheye");
  EXPECT_EQ(camera.find("distortion")->as<Node::Array>()->size(), 4U);
  EXPECT_EQ(camera.find("covariance")->as<Node::Array>()->size(), 8U);
  EXPECT_NE(camera.find("sigma")->find("k4"), nullptr);
  // The files have the lens.
  const auto written =
      read_as<MeasuredCameras>(read_toml_file(arguments_.out)).camera.front().lens().intrinsics();
  EXPECT_EQ(written.distortion.model(), LensModel::fisheye);
  EXPECT_NEAR(written.fx, truth_.fx, 0.3);
  for (const auto& [u, v] : {std::array{30.0, 90.0}, {120.0, 10.0}, {200.0, 150.0}}) {
    const auto ray = Lens(truth_).unproject({u, v});
    const auto pixel = Lens(written).project(ray->homogeneous());
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - Eigen::Vector2d(u, v)).norm(), 0.5) << u << " " << v;
  }
  write_new_file(folder_.path() / "experiment.toml", "include = ['rig.toml']\n[[arm.section]]\nlength = 1\n");
  const Experiment experiment = load_experiment(folder_.path() / "experiment.toml");
  EXPECT_EQ(experiment.camera.front().lens.model, LensModel::fisheye);
}

TEST_F(WideLens, IsNotTakenForAnotherModel) {
  arguments_.distortion = 0;
  EXPECT_THAT(run(exit_missed), testing::StartsWith("not found: "));
}

TEST_F(WideLens, SaysWhichModelsAndCoefficientsThereAre) {
  arguments_.lens = "pinhole";
  EXPECT_EQ(refusal(), "--lens: \"pinhole\": expected one of brown, rational, fisheye, best");
  arguments_.lens = "fisheye", arguments_.distortion = 5;
  EXPECT_EQ(refusal(), "--distortion: 5: expected 0 to 4 of k1, k2, k3, k4");
  arguments_.lens = "best", arguments_.distortion = 2;
  EXPECT_EQ(refusal(), "--distortion: expected a lens model, instead of --lens best");
  arguments_.distortion.reset();
  arguments_.zooms = {"1=" + folder_.path().string(), "2=" + folder_.path().string()};
  arguments_.images.clear();
  EXPECT_EQ(refusal(), "--lens: best: expected brown, rational or fisheye for --zoom");
}

}  // namespace
}  // namespace flexura
