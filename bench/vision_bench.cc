// Finding an arm's median axis in a picture, beside what OpenCV does to find it without an axis.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

// A few pictures of random arms, the same every time; made once.
const std::vector<SeenArm>& arms(int width) {
  const auto make = [](int columns) {
    SeenArmOptions options;
    options.width = columns, options.height = columns == 640 ? 480 : 1080;
    std::vector<SeenArm> made;
    for (std::uint64_t i = 0; i < 8; ++i) {
      TestRandom random(1000 + i);
      made.push_back(random_seen_arm(random, options));
    }
    return made;
  };
  static const std::vector<SeenArm> small = make(640), large = make(1920);
  return width == 640 ? small : large;
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

// Otsu's threshold, components, contours and the distance transform: whole pixels, and no axis.
void opencv(benchmark::State& state) {
  cv::setNumThreads(1);
  const std::vector<SeenArm>& seen = arms(static_cast<int>(state.range(0)));
  std::size_t i = 0;
  for (auto _ : state) {
    const Image<std::uint8_t>& picture = seen[i++ % seen.size()].picture;
    const cv::Mat gray(picture.height(), picture.width(), CV_8U,
                       const_cast<std::uint8_t*>(picture.values().data()));
    cv::Mat mask, labels, stats, centroids, distance;
    cv::threshold(gray, mask, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
    cv::connectedComponentsWithStats(mask, labels, stats, centroids);
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::distanceTransform(mask, distance, cv::DIST_L2, 5);
    benchmark::DoNotOptimize(distance.data);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(opencv)->Arg(640)->Arg(1920)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexura
