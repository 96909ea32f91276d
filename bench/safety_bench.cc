#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

// The paper's arm goes to its final position by minimum jerk within 10 s.
struct PaperMotion {
  Arm arm;
  MotionPtr motion;

  PaperMotion() {
    constexpr std::array<double, 8> lengths = {2., 3., 1., 2., 4., 2., 1., 1.};
    constexpr std::array<double, 8> archings_pi = {.05, .05, .1, .1, .05, -.3, .2, -.35};
    ArmState end = ArmState::straight(8);
    for (std::size_t i = 0; i < 8; ++i) {
      arm.sections.push_back({.length = lengths[i], .max_bend = 3, .max_bend_rate = 1});
      end.bends[i].x() = -2 * archings_pi[i] * std::numbers::pi;
    }
    motion = point_to_point_motion(ArmState::straight(8), end, std::vector(8, Profile::minimum_jerk(10)));
  }
};

void check(benchmark::State& state, const std::vector<Obstacle>& obstacles) {
  const PaperMotion paper;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        check_motions(paper.arm, obstacles, ArmState::straight(8), {{paper.motion, 0}}, 0.02));
  }
}

void check_10_s(benchmark::State& state) { check(state, {}); }
BENCHMARK(check_10_s)->Unit(benchmark::kMillisecond);

void check_10_s_with_obstacles(benchmark::State& state) {
  check(state, obstacles({PlaneConfig{.ignore_base = 0.5}, SphereConfig{.center = {-6, 12, 0}, .radius = 1},
                          BoxConfig{.center = {5, 5, 0}, .half_sizes = {1, 5, 1}}}));
}
BENCHMARK(check_10_s_with_obstacles)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
