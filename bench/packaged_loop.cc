// The packaged parts for a turn of the whole loop: llvmpipe or MuJoCo, OpenCV, ViSP.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "bench/llvmpipe_peer.h"
#include "bench/loop_camera.h"
#include "bench/mujoco_peer.h"
#include "flexura/control/feature_images.h"
#include "tests/support/visp_peer.h"

namespace flexura {
namespace {

// Gray of colour, Otsu's threshold, components, contours and the distance transform: whole pixels, and no
// axis.
class OpenCvFinder {
 public:
  void look(const Image<std::uint8_t>& picture) {
    const cv::Mat taken(picture.height(), picture.width(), picture.channels() == 1 ? CV_8UC1 : CV_8UC3,
                        const_cast<std::uint8_t*>(picture.values().data()));
    if (picture.channels() == 1)
      gray_ = taken;
    else
      cv::cvtColor(taken, gray_, cv::COLOR_RGB2GRAY);
    cv::threshold(gray_, mask_, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
    cv::connectedComponentsWithStats(mask_, labels_, stats_, centroids_);
    contours_.clear();
    cv::findContours(mask_, contours_, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::distanceTransform(mask_, distance_, cv::DIST_L2, 5);
    benchmark::DoNotOptimize(distance_.data);
  }

 private:
  cv::Mat gray_, mask_, labels_, stats_, centroids_, distance_;
  std::vector<std::vector<cv::Point>> contours_;
};

// 25 places along the arm in both pictures, as one free camera's 50 points.
std::vector<VispPoint> points_of(const ArmState& state) {
  constexpr int places = 25;
  FeatureImages images(setting_arm(), FeatureSet::of_points(places));
  std::vector<View> views;
  for (const Setting& setting : both_settings(with_rings)) views.push_back(setting.view);
  Eigen::VectorXd values;
  if (!images.values(state, views, values)) throw std::runtime_error("the arm is not seen");
  std::vector<VispPoint> points;
  for (const View& view : views) {
    for (Eigen::Index i = 0; i < places; ++i) {
      const Eigen::Vector3d p_CP = view.X_WC.inverse() * images.points().place(i);
      points.push_back({p_CP.x() / p_CP.z(), p_CP.y() / p_CP.z(), p_CP.z()});
    }
  }
  return points;
}

enum class Painter : std::uint8_t { nobody, llvmpipe_gray, llvmpipe_color, llvmpipe_smooth, mujoco };

std::unique_ptr<Peer> painter(Painter kind, const Setting& setting) {
  switch (kind) {
    case Painter::nobody:
      break;
    case Painter::llvmpipe_gray:
      return llvmpipe_peer(setting, {.pixels = PixelKind::gray});
    case Painter::llvmpipe_color:
      return llvmpipe_peer(setting, {});
    case Painter::llvmpipe_smooth:
      return llvmpipe_peer(setting, {.samples = 4, .pixels = PixelKind::gray});
    case Painter::mujoco:
      return mujoco_peer(setting, {.slices = 24, .stacks = 4});
  }
  return nullptr;
}

// The packaged parts for one turn, one after the other in one thread: two pictures, without noise; OpenCV on
// both; a step of vpServo. Nobody estimates a shape.
void packaged(benchmark::State& state, Painter kind) {
  try {
    cv::setNumThreads(1);
    const std::array<Setting, 2> settings = both_settings(with_rings);
    // One context at a time may be current: both pictures are of the first view, which is as much work.
    const std::unique_ptr<Peer> peer = painter(kind, settings[0]);
    std::array<Image<std::uint8_t>, 2> pictures;
    for (std::size_t i = 0; i < 2; ++i) {
      LoopCamera camera{.view = settings[i].view, .number = i};
      look(camera, settings[i].scene, 0);
      pictures[i] = peer ? peer->picture().pixels : camera.picture;
    }
    std::array<OpenCvFinder, 2> finders;
    const std::vector<VispPoint> now = points_of(setting_state());
    ArmState goal = setting_state();
    for (Eigen::Vector2d& bend : goal.bends) bend *= 0.93;
    VispServo servo(points_of(goal), 0.5);
    for (auto _ : state) {
      for (int i = 0; peer && i < 2; ++i) peer->draw();
      for (std::size_t i = 0; i < 2; ++i) finders[i].look(pictures[i]);
      benchmark::DoNotOptimize(servo.velocity(now));
    }
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(packaged, opencv_and_visp, Painter::nobody)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(packaged, with_llvmpipe_gray, Painter::llvmpipe_gray)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(packaged, with_llvmpipe_color, Painter::llvmpipe_color)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(packaged, with_llvmpipe_gray_4_samples, Painter::llvmpipe_smooth)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(packaged, with_mujoco, Painter::mujoco)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
