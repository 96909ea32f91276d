// Benchmarks of estimating the arm's shape from two pictures of 640 x 480 px, without a start and tracking
// from the picture before.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "flexura/estimate/picture_observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_tracker.h"
#include "flexura/vision/arm_finder.h"
#include "tests/support/seen_arms.h"
#include "tests/support/shape_error.h"

namespace flexura {
namespace {

// An arm of three sections that swings back and forth in front of two cameras, by some pixels from picture to
// picture.
struct Film {
  Arm arm;
  std::array<View, 2> views;
  std::vector<std::array<Image<std::uint8_t>, 2>> frames;
  std::vector<std::vector<Observation>> observations;
  std::vector<ArmState> states;
};

Film make_film() {
  Film film;
  film.arm.kind = ArmKind::spatial;
  film.arm.sections.resize(3, {.length = 0.33, .radius = {0.018, 0.018}});
  const Eigen::Vector3d middle(0, 0.45, 0);
  film.views = {pinhole_view(look_at({0, 0.45, 2}, middle), 640, 480, 800),
                pinhole_view(look_at({-2, 0.45, 0}, middle), 640, 480, 800)};
  constexpr std::uint64_t count = 16;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double swing = 0.03 * static_cast<double>(i < count / 2 ? i : count - i);
    ArmState state = ArmState::straight(3);
    state.bends = {{0.5 + swing, 0.4}, {-0.9, 0.6 + swing}, {0.8, -0.7 - swing}};
    film.states.push_back(state);
    Scene scene;
    scene.background = Color::Constant(0.8);
    scene.arm.tube = tube_of(Backbone(film.arm, state));
    scene.arm.albedo = {0.08, 0.08, 0.09};
    auto& frame = film.frames.emplace_back();
    auto& seen = film.observations.emplace_back();
    for (std::size_t j = 0; j < 2; ++j) {
      frame[j] = photograph(scene, film.views[j], {}, 2 * i + j);
      ArmFinder finder({.threshold = {}, .base = film.views[j].project(film.arm.X_WB.position)});
      seen.push_back(observation_of(finder.find(frame[j]), film.views[j]));
    }
  }
  return film;
}

const Film& film() {
  static const Film made = make_film();
  return made;
}

// Returns an estimator with prior knowledge: 0: the arm; 1: only base position and length.
ShapeEstimator estimator(std::int64_t known) {
  const Arm& arm = film().arm;
  return ShapeEstimator(known == 0 ? ShapePrior{.arm = arm} : unknown_arm(arm.X_WB.position, arm.length()));
}

void require(const ShapeEstimate& found) {
  if (!found.is_found) throw std::runtime_error(found.reason);
}

void fit_cold(benchmark::State& state) {
  ShapeEstimator fit = estimator(state.range(0));
  std::size_t i = 0, iterations = 0;
  for (auto _ : state) {
    const ShapeEstimate found = fit.estimate(film().observations[i++ % film().observations.size()]);
    require(found), iterations += static_cast<std::size_t>(found.iterations);
  }
  state.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(fit_cold)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// The same arm, described by many equal sections.
void fit_sections(benchmark::State& state) {
  Arm arm = film().arm;
  const double length = arm.length() / static_cast<double>(state.range(0));
  arm.sections.assign(static_cast<std::size_t>(state.range(0)), {.length = length, .radius = {0.018, 0.018}});
  ShapeEstimator fit(described_arm(arm));
  std::size_t i = 0;
  double worst = 0;
  for (auto _ : state) {
    const std::size_t frame = i++ % film().observations.size();
    const ShapeEstimate found = fit.estimate(film().observations[frame]);
    require(found);
    worst = std::max(worst, shape_error(found.shape, Backbone(film().arm, film().states[frame])));
  }
  state.counters["worst_mm"] = 1000 * worst;
}
BENCHMARK(fit_sections)->Arg(3)->Arg(9)->Arg(15)->Arg(30)->Arg(60)->Arg(99)->Unit(benchmark::kMillisecond);

void fit_following(benchmark::State& state) {
  ShapeEstimator fit = estimator(state.range(0));
  Shape before = fit.estimate(film().observations.back()).shape;
  std::size_t i = 0, iterations = 0;
  for (auto _ : state) {
    const ShapeEstimate found = fit.follow(film().observations[i++ % film().observations.size()], before);
    require(found), iterations += static_cast<std::size_t>(found.iterations);
    before = found.shape;
  }
  state.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(fit_following)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// Tracks as a servo does: camera errors are estimated, too, earlier observations count, and the drives'
// commands predict the motion.
void fit_tracking(benchmark::State& state) {
  std::vector<std::vector<Observation>> observations = film().observations;
  for (std::vector<Observation>& seen : observations)
    for (Observation& one : seen) one.view_prior = {.rotation_std = 0.02, .focal_std = 0.02};
  ShapeTracker tracker({.arm = film().arm}, {});
  std::optional<ArmState> expected;
  std::size_t i = 0, iterations = 0;
  for (auto _ : state) {
    const std::size_t now = i % observations.size(), next = (i + 1) % observations.size();
    const ShapeEstimate found = tracker.look(observations[now], static_cast<double>(i++) / 30, expected);
    require(found), iterations += static_cast<std::size_t>(found.iterations);
    expected = found.shape.state;
    for (std::size_t k = 0; k < expected->bends.size(); ++k)
      expected->bends[k] += film().states[next].bends[k] - film().states[now].bends[k];
  }
  state.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(fit_tracking)->Unit(benchmark::kMicrosecond);

std::vector<Observation> looks_at(std::size_t frame, std::array<ArmFinder, 2>& finders) {
  std::vector<Observation> seen;
  seen.reserve(2);
  for (std::size_t j = 0; j < 2; ++j)
    seen.push_back(observation_of(finders[j].find(film().frames[frame][j]), film().views[j]));
  return seen;
}

std::array<ArmFinder, 2> make_finders() {
  const Film& seen = film();
  const auto config = [&](std::size_t i) {
    return ArmFinderConfig{.threshold = {}, .base = seen.views[i].project(seen.arm.X_WB.position)};
  };
  return {ArmFinder(config(0)), ArmFinder(config(1))};
}

void pictures_cold(benchmark::State& state) {
  ShapeEstimator fit = estimator(state.range(0));
  std::array<ArmFinder, 2> finders = make_finders();
  std::size_t i = 0;
  for (auto _ : state) require(fit.estimate(looks_at(i++ % film().frames.size(), finders)));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(pictures_cold)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void pictures_following(benchmark::State& state) {
  ShapeEstimator fit = estimator(state.range(0));
  std::array<ArmFinder, 2> finders = make_finders();
  Shape before = fit.estimate(film().observations.back()).shape;
  std::size_t i = 0;
  for (auto _ : state) {
    const ShapeEstimate found = fit.follow(looks_at(i++ % film().frames.size(), finders), before);
    require(found);
    before = found.shape;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(pictures_following)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexura
