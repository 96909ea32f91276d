// Calibrating cameras from the corners of boards, beside OpenCV; corners are found already. Thirteen views of
// a 9 x 6 board with noise 0.15 px, as opencv-doc's pictures have them.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "flexura/calibrate/board_target.h"
#include "flexura/calibrate/intrinsics_fit.h"
#include "flexura/math/so3.h"
#include "tests/support/boards.h"

namespace flexura {
namespace {

const BoardTarget board;
const std::vector<Eigen::Vector2d> points = board.points();

// What the first cameras of a pair see.
std::vector<BoardView> views_of(std::size_t cameras) {
  const Intrinsics lens{
      .fx = 533, .fy = 533, .cx = 342, .cy = 234, .distortion = {-0.28, 0.04, 0.001, 0, 0.02}};
  BoardBundle truth{{lens, lens}, {Pose{}, {so3_exp({0.01, 0.01, 0}), {0.083, 0, 0}}}, {}};
  truth.lenses.resize(cameras), truth.cameras.resize(cameras);
  TestRandom random(1);
  for (int i = 0; i < 13; ++i) truth.boards.push_back(random_board(random, board, 0.4, 0.6, 0.1));
  return seen_boards(truth, points, 0.15, random);
}

void calibrate(benchmark::State& state) {
  const auto cameras = static_cast<std::size_t>(state.range(0));
  const std::vector<BoardView> views = views_of(cameras);
  const std::vector<std::array<int, 2>> sizes(cameras, {640, 480});
  IntrinsicsFit fit;
  for (auto _ : state) fit = fit_intrinsics(points, views, sizes);
  state.counters["rms_px"] = fit.rms;
}
BENCHMARK(calibrate)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

struct OpenCvBoards {
  std::vector<std::vector<cv::Point3f>> there;
  std::vector<std::vector<cv::Point2f>> left, right;
};

OpenCvBoards opencv_boards() {
  OpenCvBoards boards;
  for (const BoardView& view : views_of(2)) {
    auto& there = boards.there.emplace_back();
    auto &left = boards.left.emplace_back(), &right = boards.right.emplace_back();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2f point = points[i].cast<float>(), l = view.pixels[0][i].cast<float>(),
                            r = view.pixels[1][i].cast<float>();
      there.emplace_back(point.x(), point.y(), 0.0F);
      left.emplace_back(l.x(), l.y()), right.emplace_back(r.x(), r.y());
    }
  }
  return boards;
}

void opencv_calibrates(benchmark::State& state) {
  const OpenCvBoards boards = opencv_boards();
  double rms = 0;
  for (auto _ : state) {
    cv::Mat K, distortion, other, other_distortion, R, t, E, F;
    std::vector<cv::Mat> rotations, positions;
    rms = cv::calibrateCamera(boards.there, boards.left, {640, 480}, K, distortion, rotations, positions);
    if (state.range(0) == 1) continue;
    cv::calibrateCamera(boards.there, boards.right, {640, 480}, other, other_distortion, rotations,
                        positions);
    rms = cv::stereoCalibrate(boards.there, boards.left, boards.right, K, distortion, other, other_distortion,
                              {640, 480}, R, t, E, F, cv::CALIB_USE_INTRINSIC_GUESS);
  }
  state.counters["rms_px"] = rms;
}
BENCHMARK(opencv_calibrates)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
