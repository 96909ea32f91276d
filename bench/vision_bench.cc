// Benchmarks of finding an arm's centerline in a picture, compared with OpenCV's steps, which give no
// centerline.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

std::vector<SeenArm> random_arms(int columns, bool color) {
  SeenArmConfig options;
  options.width = columns, options.height = columns == 640 ? 480 : 1080, options.color = color;
  std::vector<SeenArm> made;
  for (std::uint64_t i = 0; i < 8; ++i) {
    TestRandom random(1000 + i);
    made.push_back(random_seen_arm(random, options));
  }
  return made;
}

// Returns a few pictures of random arms, made once and always the same.
const std::vector<SeenArm>& arms(int width) {
  static const std::vector<SeenArm> small = random_arms(640, false), large = random_arms(1920, false);
  return width == 640 ? small : large;
}

const std::vector<SeenArm>& arms_in_color() {
  static const std::vector<SeenArm> made = random_arms(640, true);
  return made;
}

void find_arm(benchmark::State& state) {
  const std::vector<SeenArm>& seen = arms(static_cast<int>(state.range(0)));
  ArmFinder finder;
  std::size_t i = 0, samples = 0;
  for (auto _ : state) samples += finder.find(seen[i++ % seen.size()].picture).axis.size();
  state.counters["samples"] = static_cast<double>(samples) / static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(find_arm)->Arg(640)->Arg(1920)->Unit(benchmark::kMicrosecond);

void find_arm_in_color(benchmark::State& state) {
  const std::vector<SeenArm>& seen = arms_in_color();
  ArmFinder finder;
  std::size_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(finder.find(gray_picture(seen[i++ % seen.size()].picture)).axis.size());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(find_arm_in_color)->Unit(benchmark::kMicrosecond);

void find_backbone(benchmark::State& state) {
  const std::vector<SeenArm>& seen = arms(640);
  ArmFinder finder;
  std::size_t i = 0;
  for (auto _ : state) {
    const SeenArm& arm = seen[i++ % seen.size()];
    auto axis = finder.find(arm.picture).axis;
    to_backbone_image(arm.view.lens, axis);
    benchmark::DoNotOptimize(axis);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(find_backbone)->Unit(benchmark::kMicrosecond);

void threshold_and_components(benchmark::State& state) {
  const std::vector<SeenArm>& seen = arms(static_cast<int>(state.range(0)));
  Components components;
  std::size_t i = 0;
  for (auto _ : state) {
    const Image<std::uint8_t>& picture = seen[i++ % seen.size()].picture;
    components.find(picture, threshold_of(picture, {}, 12288));
    benchmark::DoNotOptimize(components);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(threshold_and_components)->Arg(640)->Arg(1920)->Unit(benchmark::kMicrosecond);

// Finds the arm by OpenCV: Otsu's threshold, components, contours and distance transform. This gives whole
// pixels and no centerline.
void find_by_opencv(const cv::Mat& gray) {
  cv::Mat mask, labels, stats, centroids, distance;
  cv::threshold(gray, mask, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
  cv::connectedComponentsWithStats(mask, labels, stats, centroids);
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::distanceTransform(mask, distance, cv::DIST_L2, 5);
  benchmark::DoNotOptimize(distance.data);
}

cv::Mat matrix_of(const Image<std::uint8_t>& picture, int type) {
  return {picture.height(), picture.width(), type, const_cast<std::uint8_t*>(picture.values().data())};
}

void opencv(benchmark::State& state) {
  cv::setNumThreads(1);
  const std::vector<SeenArm>& seen = arms(static_cast<int>(state.range(0)));
  std::size_t i = 0;
  for (auto _ : state) find_by_opencv(matrix_of(seen[i++ % seen.size()].picture, CV_8U));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(opencv)->Arg(640)->Arg(1920)->Unit(benchmark::kMicrosecond);

void opencv_in_color(benchmark::State& state) {
  cv::setNumThreads(1);
  const std::vector<SeenArm>& seen = arms_in_color();
  std::size_t i = 0;
  cv::Mat gray;
  for (auto _ : state) {
    cv::cvtColor(matrix_of(seen[i++ % seen.size()].picture, CV_8UC3), gray, cv::COLOR_RGB2GRAY);
    find_by_opencv(gray);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(opencv_in_color)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexura
