// Benchmarks of the whole servo loop with two noisy pictures of 640 x 480 px a cycle: rendering,
// segmentation, shape estimation, control. packaged_loop.cc has the sum of the best packaged parts for
// comparison.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <semaphore>
#include <stdexcept>
#include <thread>
#include <utility>

#include "bench/loop_camera.h"
#include "flexura/control/limiter.h"
#include "flexura/estimate/backbone_pixels.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/servo/servo_error.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_law.h"

namespace flexura {
namespace {

// Repeats one task in its own thread.
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

// An arm servoed back and forth between two shapes by its pictures.
class Loop {
 public:
  Loop(int threads, const Sides& sides, bool predicts) : predicts_(predicts) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Setting setting = both_settings(sides)[i];
      scene_ = setting.scene;
      cameras_[i].view = setting.view, cameras_[i].number = i;
      cameras_[i].finder =
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
    law_.emplace(ArmModel(arm_), config_, *features_);
  }

  void turn() {
    Stopwatch own;
    constexpr int turns_a_goal = 20;
    const TargetShape& desired = goals_[static_cast<std::size_t>(turns_ / turns_a_goal % 2)];
    scene_.arm.tube = tube_of(Backbone(arm_, state_));
    const auto number = static_cast<std::uint64_t>(turns_++);
    predict();
    if (helper_) helper_->start([this, number] { look(cameras_[1], scene_, number); });
    look(cameras_[0], scene_, number);
    helper_ ? helper_->wait() : look(cameras_[1], scene_, number);
    Stopwatch watch;
    observed_.seen = {cameras_[0].seen, cameras_[1].seen};
    observed_.estimate = observed_.estimate.is_found ? estimator_.follow(observed_.seen, {arm_, expected_})
                                                     : estimator_.estimate(observed_.seen);
    if (!observed_.estimate.is_found) throw std::runtime_error(observed_.estimate.reason);
    observed_.rest = observed_.estimate.shape.state;  // The arm does not swing.
    fitting_ += watch.lap();
    const ServoLaw::Output output = law_->step({.observed = observed_,
                                                .is_fresh = true,
                                                .measured = state_,
                                                .sent = state_,
                                                .then = desired,
                                                .desired = desired,
                                                .next = desired.state});
    control_ += watch.lap();
    const ArmState before = std::exchange(state_, limiter_.next(output.asked).state);
    limiting_ += watch.lap();
    expected_ = observed_.estimate.shape.state;
    off_ = std::max(off_, servo_error(arm_, expected_, before).rms);
    // The last estimate, moved by the commands sent since.
    for (std::size_t i = 0; i < expected_.bends.size(); ++i)
      expected_.bends[i] += state_.bends[i] - before.bends[i];
    own_ += own.lap();
  }

  // Reports CPU times, us per cycle, for both cameras together. `own_us`: total of the calling thread.
  void report(benchmark::State& state) const {
    const double us = 1e6 / static_cast<double>(turns_);
    state.counters["draw_us"] = us * (cameras_[0].drawing + cameras_[1].drawing);
    state.counters["sensor_us"] = us * (cameras_[0].reading + cameras_[1].reading);
    state.counters["find_us"] = us * (cameras_[0].finding + cameras_[1].finding);
    state.counters["fit_us"] = us * fitting_;
    state.counters["law_us"] = us * control_;
    state.counters["limiter_us"] = us * limiting_;
    state.counters["own_us"] = us * own_;
    state.counters["off"] = off_;
  }

 private:
  // Predicts where the pictures show the arm, as a servo does.
  void predict() {
    if (!predicts_ || !observed_.estimate.is_found) return;
    Stopwatch watch;
    constexpr int points = 48;
    for (LoopCamera& camera : cameras_)
      camera.expected = backbone_pixels(arm_, expected_, camera.view, points);
    cameras_[0].finding += watch.lap();
  }

  Arm arm_ = setting_arm();
  ArmState state_ = setting_state(), expected_;
  Scene scene_;
  std::array<LoopCamera, 2> cameras_;
  ShapeEstimator estimator_{ShapePrior{.arm = arm_}};
  std::array<TargetShape, 2> goals_;
  ServoConfig config_;
  std::unique_ptr<ServoFeatures> features_;
  std::optional<ServoLaw> law_;
  CommandLimiter limiter_{arm_, {.looks_ahead = false}, state_};
  ServoObservation observed_;
  std::unique_ptr<Helper> helper_;
  bool predicts_ = true;
  int turns_ = 0;
  double fitting_ = 0, control_ = 0, limiting_ = 0, own_ = 0;  // s
  double off_ = 0;  // Rms error of the worst estimate, relative to the length.
};

void whole_loop(benchmark::State& state, const Sides& sides, bool predicts) {
  try {
    Loop loop(static_cast<int>(state.range(0)), sides, predicts);
    loop.turn();
    for (auto _ : state) loop.turn();
    loop.report(state);
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(whole_loop, rings, with_rings, true)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_loop, no_rings, without_rings, true)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

// The arm is searched in each picture without a prediction.
BENCHMARK_CAPTURE(whole_loop, no_rings_searched, without_rings, false)
    ->Arg(1)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
