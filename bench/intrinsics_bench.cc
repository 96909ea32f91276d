// Calibrating cameras from the corners of boards, beside OpenCV; corners are found already. Thirteen views of
// a 9 x 6 board: drawn ones with noise 0.15 px, and the pairs of pictures of Debian's package opencv-doc.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "flexura/board/board_finder.h"
#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"
#include "flexura/math/so3.h"
#include "flexura/picture/image_file.h"
#include "tests/support/boards.h"

namespace flexura {
namespace {

using Views = std::vector<BoardView>;

const BoardTarget board;
const std::vector<Eigen::Vector2d> points = board.points();

// What a pair of cameras sees.
Views drawn_pairs() {
  const Intrinsics lens{
      .fx = 533, .fy = 533, .cx = 342, .cy = 234, .distortion = {-0.28, 0.04, 0.001, 0, 0.02}};
  BoardBundle truth{{lens, lens}, {Pose{}, {so3_exp({0.01, 0.01, 0}), {0.083, 0, 0}}}, {}};
  TestRandom random(1);
  for (int i = 0; i < 13; ++i) truth.boards.push_back(random_board(random, board, 0.4, 0.6, 0.1));
  return seen_boards(truth, points, 0.15, random);
}

// None where a picture is not there or shows no board.
Views real_pairs() {
  const std::filesystem::path folder = "/usr/share/doc/opencv-doc/examples/data";
  Views views;
  for (int number = 1; number <= 14; ++number) {
    if (number == 10) continue;
    BoardView& view = views.emplace_back();
    for (const char* side : {"left", "right"}) {
      const std::string name = std::string(side) + (number < 10 ? "0" : "") + std::to_string(number) + ".jpg";
      std::ifstream in(folder / name, std::ios::binary);
      if (!in) return {};
      const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
      const BoardObservation seen =
          find_board(std::get<Image<std::uint8_t>>(read_picture(bytes, name, 1 << 20)), board);
      if (!seen.is_found()) return {};
      view.pixels.push_back(seen.pixels);
    }
  }
  return views;
}

const Views& pairs(bool are_real) {
  static const Views drawn = drawn_pairs(), real = real_pairs();
  return are_real ? real : drawn;
}

// What one camera of them sees.
Views side(const Views& pairs, std::size_t camera) {
  Views views;
  for (const BoardView& pair : pairs) views.push_back({{pair.pixels[camera]}});
  return views;
}

// The first camera alone; or each alone, and then both with the step between them.
enum Cameras : std::uint8_t { one, each_and_both };

void calibrate(benchmark::State& state, bool are_real, Cameras cameras) {
  const Views& both = pairs(are_real);
  if (both.empty()) {
    state.SkipWithError("the pictures of opencv-doc are not there");
    return;
  }
  const Views left = side(both, 0), right = side(both, 1);
  constexpr std::array<std::array<int, 2>, 2> sizes = {{{640, 480}, {640, 480}}};
  const std::span<const std::array<int, 2>> size(sizes.data(), 1);
  double rms = 0;
  for (auto _ : state) {
    rms = fit_intrinsics(points, left, size).rms;
    if (cameras == one) continue;
    benchmark::DoNotOptimize(fit_intrinsics(points, right, size).rms);
    rms = fit_intrinsics(points, both, sizes).rms;
  }
  state.counters["rms_px"] = rms;
}
BENCHMARK_CAPTURE(calibrate, drawn_one, false, one)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(calibrate, drawn_each_and_both, false, each_and_both)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(calibrate, real_one, true, one)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(calibrate, real_each_and_both, true, each_and_both)->Unit(benchmark::kMillisecond);

struct OpenCvBoards {
  std::vector<std::vector<cv::Point3f>> there;
  std::vector<std::vector<cv::Point2f>> left, right;
};

OpenCvBoards opencv_boards(const Views& views) {
  OpenCvBoards boards;
  for (const BoardView& view : views) {
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

void opencv_calibrates(benchmark::State& state, bool are_real, Cameras cameras) {
  const OpenCvBoards boards = opencv_boards(pairs(are_real));
  if (boards.there.empty()) {
    state.SkipWithError("the pictures of opencv-doc are not there");
    return;
  }
  double rms = 0;
  for (auto _ : state) {
    cv::Mat K, distortion, other, other_distortion, R, t, E, F;
    std::vector<cv::Mat> rotations, positions;
    rms = cv::calibrateCamera(boards.there, boards.left, {640, 480}, K, distortion, rotations, positions);
    if (cameras == one) continue;
    cv::calibrateCamera(boards.there, boards.right, {640, 480}, other, other_distortion, rotations,
                        positions);
    rms = cv::stereoCalibrate(boards.there, boards.left, boards.right, K, distortion, other, other_distortion,
                              {640, 480}, R, t, E, F, cv::CALIB_USE_INTRINSIC_GUESS);
  }
  state.counters["rms_px"] = rms;
}
BENCHMARK_CAPTURE(opencv_calibrates, drawn_one, false, one)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(opencv_calibrates, drawn_each_and_both, false, each_and_both)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(opencv_calibrates, real_one, true, one)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(opencv_calibrates, real_each_and_both, true, each_and_both)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
