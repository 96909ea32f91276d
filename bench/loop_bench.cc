// The whole loop of a servo, two noisy pictures of 640 x 480 px a turn: rendered, segmented, the shape
// estimated, the arm controlled; beside the sum of the best packaged parts for it.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <exception>
#include <functional>
#include <memory>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <semaphore>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "bench/llvmpipe_peer.h"
#include "bench/mujoco_peer.h"
#include "bench/render_scene.h"
#include "flexura/control/feature_images.h"
#include "flexura/control/limiter.h"
#include "flexura/estimate/picture_sighting.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_law.h"
#include "flexura/vision/arm_finder.h"
#include "tests/support/visp_peer.h"

namespace flexura {
namespace {

constexpr int width = 640, height = 480;

// The scene of the renderers' comparison, with its rings or without, from two sides, rad.
struct Sides {
  bool has_rings = true;
  double aside = 0.17;
};

// From farther aside rings are drawn the exact way, which takes twenty times as long and is not the matter
// here.
constexpr Sides near_sides = {}, far_sides = {false, 0.52};

Setting setting_from(const Sides& sides, double angle) {
  Setting result = setting(width, height);
  if (!sides.has_rings) result.scene.arm.markers.clear();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector3d middle(0.19, 0.054, 0);
  result.view.X_WC.position = middle + turn * (result.view.X_WC.position - middle);
  result.view.X_WC.rotation = (turn * result.view.X_WC.rotation).eval();
  return result;
}

std::array<Setting, 2> both_settings(const Sides& sides) {
  return {setting_from(sides, -sides.aside), setting_from(sides, sides.aside)};
}

SensorConfig noisy() {
  return {.width = width, .height = height, .full_well = 10000, .read_noise = 1.5, .psf = 0.7};
}

// One camera, and what it takes to see the arm with it.
struct Eye {
  View view = {};
  std::uint64_t number = 0;
  Sensor sensor = Sensor(noisy());
  Renderer renderer = Renderer();
  LightImage light = {};
  SensorRows rows = {};
  Image<std::uint8_t> picture = Image<std::uint8_t>(width, height);
  ArmFinder finder = ArmFinder();
  Sighting seen = {};
  double drawing = 0, reading = 0, finding = 0;  // s, of all turns
};

// Of the calling thread's processor time: others on the machine do not count.
class Stopwatch {
 public:
  double lap() {
    const double now = used();
    return now - std::exchange(last_, now);
  }

 private:
  static double used() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double last_ = used();
};

void look(Eye& eye, const Scene& scene, std::uint64_t turn) {
  Stopwatch watch;
  eye.renderer.render(scene, eye.view, PixelKind::gray, eye.light);
  eye.drawing += watch.lap();
  eye.sensor.read(eye.light.light, {1, eye.number, turn}, eye.rows, eye.picture);
  eye.reading += watch.lap();
  eye.seen = sighting_of(eye.finder.find(eye.picture), eye.view);
  eye.finding += watch.lap();
}

// Does one thing again and again in a thread of its own.
class Helper {
 public:
  ~Helper() {
    is_over_ = true;
    go_.release();
    thread_.join();
  }
  Helper() : thread_([this] { work(); }) {}
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;
  template <class Job>
  void start(Job job) {
    job_ = std::move(job);
    go_.release();
  }
  void wait() { done_.acquire(); }

 private:
  void work() {
    for (go_.acquire(); !is_over_; go_.acquire()) job_(), done_.release();
  }
  std::function<void()> job_;
  bool is_over_ = false;
  std::binary_semaphore go_{0}, done_{0};
  std::thread thread_;
};

// An arm that goes to and fro between two shapes as its pictures tell.
class Loop {
 public:
  Loop(int threads, const Sides& sides) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Setting setting = both_settings(sides)[i];
      scene_ = setting.scene;
      eyes_[i].view = setting.view, eyes_[i].number = i;
      eyes_[i].finder =
          ArmFinder({.threshold = {}, .base = setting.view.project(arm_.X_WB.position), .least_sigma = 0});
    }
    if (threads > 1) helper_ = std::make_unique<Helper>();
    for (std::size_t goal = 0; goal < 2; ++goal) {
      goals_[goal].state = setting_state();
      for (Eigen::Vector2d& bend : goals_[goal].state.bends) bend *= goal == 0 ? 0.93 : 1.0;
    }
    config_.law = ServoLawKind::points;
    config_.goals = {{0, goals_[0].state}};
    features_ = servo_features(config_.law, arm_, config_.points);
    law_.emplace(arm_, config_, *features_);
  }

  void turn() {
    Stopwatch own;
    constexpr int turns_a_goal = 20;
    const WantedShape& wanted = goals_[static_cast<std::size_t>(turns_ / turns_a_goal % 2)];
    scene_.arm.tube = tube_of(arm_, Backbone(arm_, state_));
    const auto number = static_cast<std::uint64_t>(turns_++);
    if (helper_) helper_->start([this, number] { look(eyes_[1], scene_, number); });
    look(eyes_[0], scene_, number);
    helper_ ? helper_->wait() : look(eyes_[1], scene_, number);
    Stopwatch watch;
    sight_.seen = {eyes_[0].seen, eyes_[1].seen};
    sight_.estimate = sight_.estimate.is_found ? estimator_.follow(sight_.seen, {arm_, expected_})
                                               : estimator_.estimate(sight_.seen);
    if (!sight_.estimate.is_found) throw std::runtime_error(sight_.estimate.reason);
    fitting_ += watch.lap();
    const ServoLaw::Wish wish = law_->step({.sight = sight_,
                                            .is_fresh = true,
                                            .said = state_,
                                            .sent = state_,
                                            .then = wanted,
                                            .wanted = wanted,
                                            .next = wanted.state});
    control_ += watch.lap();
    const ArmState before = std::exchange(state_, limiter_.next(wish.asked).state);
    limiting_ += watch.lap();
    expected_ = sight_.estimate.shape.state;
    off_ = std::max(off_, servo_error(arm_, expected_, before).rms);
    // Where it was seen, moved by what was sent since.
    for (std::size_t i = 0; i < expected_.bends.size(); ++i)
      expected_.bends[i] += state_.bends[i] - before.bends[i];
    own_ += own.lap();
  }

  // Processor times in us a turn, of both cameras together; `own_us`: all that the calling thread does.
  void tell(benchmark::State& state) const {
    const double us = 1e6 / static_cast<double>(turns_);
    state.counters["draw_us"] = us * (eyes_[0].drawing + eyes_[1].drawing);
    state.counters["sensor_us"] = us * (eyes_[0].reading + eyes_[1].reading);
    state.counters["find_us"] = us * (eyes_[0].finding + eyes_[1].finding);
    state.counters["fit_us"] = us * fitting_;
    state.counters["law_us"] = us * control_;
    state.counters["limiter_us"] = us * limiting_;
    state.counters["own_us"] = us * own_;
    state.counters["off"] = off_;
  }

 private:
  Arm arm_ = setting_arm();
  ArmState state_ = setting_state(), expected_;
  Scene scene_;
  std::array<Eye, 2> eyes_;
  ShapeEstimator estimator_{ShapePrior{.arm = arm_}};
  std::array<WantedShape, 2> goals_;
  ServoConfig config_;
  std::unique_ptr<ServoFeatures> features_;
  std::optional<ServoLaw> law_;
  CommandLimiter limiter_{arm_, {.looks_ahead = false}, state_};
  ServoSight sight_;
  std::unique_ptr<Helper> helper_;
  int turns_ = 0;
  double fitting_ = 0, control_ = 0, limiting_ = 0, own_ = 0;  // s
  double off_ = 0;  // Of the worst estimate, from the truth, root mean square, share of the length.
};

void whole_loop(benchmark::State& state, const Sides& sides) {
  try {
    Loop loop(static_cast<int>(state.range(0)), sides);
    loop.turn();
    for (auto _ : state) loop.turn();
    loop.tell(state);
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(whole_loop, rings, near_sides)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_loop, no_rings, far_sides)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

// Gray of colour, Otsu's threshold, components, contours and the distance transform: whole pixels, and no
// axis.
class OpenCvEye {
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
  for (const Setting& setting : both_settings(near_sides)) views.push_back(setting.view);
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
    const std::array<Setting, 2> settings = both_settings(near_sides);
    // One context at a time may be current: both pictures are of the first view, which is as much work.
    const std::unique_ptr<Peer> peer = painter(kind, settings[0]);
    std::array<Image<std::uint8_t>, 2> pictures;
    for (std::size_t i = 0; i < 2; ++i) {
      Eye eye{.view = settings[i].view, .number = i};
      look(eye, settings[i].scene, 0);
      pictures[i] = peer ? peer->picture().pixels : eye.picture;
    }
    std::array<OpenCvEye, 2> eyes;
    const std::vector<VispPoint> now = points_of(setting_state());
    ArmState goal = setting_state();
    for (Eigen::Vector2d& bend : goal.bends) bend *= 0.93;
    VispServo servo(points_of(goal), 0.5);
    for (auto _ : state) {
      for (int i = 0; peer && i < 2; ++i) peer->draw();
      for (std::size_t i = 0; i < 2; ++i) eyes[i].look(pictures[i]);
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
