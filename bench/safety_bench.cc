#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/safety/drive_check.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

constexpr double step = 0.01;    // s
constexpr double duration = 10;  // s

// Returns the laboratory arm of the examples: three spatial sections.
Arm laboratory_arm() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  constexpr std::array<double, 3> lengths = {0.30, 0.25, 0.20};
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double radius = 0.025 - 0.003 * static_cast<double>(i);
    arm.sections.push_back({.length = lengths[i],
                            .radius = {radius, radius - 0.003},
                            .max_bend = 120 * degree,
                            .max_bend_rate = 90 * degree});
  }
  return arm;
}

// Returns a motion of 10 s that bows, curls and sways without touching anything.
MotionPtr laboratory_motion() {
  const auto state = [](std::array<double, 6> bends) {
    ArmState result = ArmState::straight(3);
    for (std::size_t i = 0; i < 3; ++i) result.bends[i] = {bends[2 * i] * degree, bends[2 * i + 1] * degree};
    return result;
  };
  return keyframe_motion({0, 2, 5, 8, duration},
                         {state({}), state({60, 0, 0, 0, 0, 0}), state({60, 0, 0, 90, -60, 60}),
                          state({-40, 30, 0, -60, 60, 0}), state({})},
                         Interpolation::smooth);
}

std::vector<ObstacleConfig> some_obstacles() {
  return {PlaneConfig{.ignore_base = 0.05}, SphereConfig{.center = {-0.5, 0.6, 0}, .radius = 0.1},
          CapsuleConfig{.from = {0.6, 0, 0.6}, .to = {0.6, 1, 0.6}, .radius = 0.03},
          BoxConfig{.center = {0, 0.1, -0.6}, .half_sizes = {0.3, 0.1, 0.2}}};
}

void check(benchmark::State& state, const Arm& arm, const MotionPtr& motion,
           const std::vector<ObstacleConfig>& around) {
  const std::vector<Obstacle> bodies = obstacles(around);
  const SafetyReport report = check_motions(arm, bodies, motion->at(0), {{motion, 0}}, step);
  if (!report.is_safe()) {
    state.SkipWithError(report.violations.front().text().c_str());
    return;
  }
  for (auto _ : state)
    benchmark::DoNotOptimize(check_motions(arm, bodies, motion->at(0), {{motion, 0}}, step));
}

void laboratory_10_s(benchmark::State& state) { check(state, laboratory_arm(), laboratory_motion(), {}); }
BENCHMARK(laboratory_10_s)->Unit(benchmark::kMillisecond);

void laboratory_10_s_four_obstacles(benchmark::State& state) {
  check(state, laboratory_arm(), laboratory_motion(), some_obstacles());
}
BENCHMARK(laboratory_10_s_four_obstacles)->Unit(benchmark::kMillisecond);

// The same motion as a function of time, which the check has to sample at every clock step.
void laboratory_10_s_sampled(benchmark::State& state) {
  const MotionPtr law = laboratory_motion();
  check(state, laboratory_arm(), function_motion(duration, [law](double t) { return law->at(t); }),
        some_obstacles());
}
BENCHMARK(laboratory_10_s_sampled)->Unit(benchmark::kMillisecond);

// Checks nine motors at every row of the command list, and by the motion law's rates between the rows.
void laboratory_10_s_motors(benchmark::State& state) {
  const Arm arm = laboratory_arm();
  Drive drive;
  for (std::size_t i = 0; i < 9; ++i) {
    const std::size_t section = i / 3;
    drive.tendons.push_back({section, 0.014, static_cast<double>(40 * section + 120 * (i % 3)) * degree});
    drive.axes.push_back(
        {.motor = {.max_speed = 60}, .spool = {.radius = 0.01, .gear = 10, .backlash = 0.002}});
  }
  std::vector<double> times;
  for (int k = 0; k <= std::lround(duration / step); ++k) times.push_back(k * step);
  const MotionPtr motion = laboratory_motion();
  const auto rates = [&](double start, double end) -> std::optional<std::vector<SectionRates>> {
    std::vector<SectionRates> all;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const auto known = motion->rates(i, start, end);
      if (!known) return std::nullopt;
      all.push_back(*known);
    }
    return all;
  };
  for (auto _ : state) {
    SafetyReport report;
    check_drive(arm, drive, [&](double t) { return motion->at(t); }, times, rates, report);
    benchmark::DoNotOptimize(report);
  }
}
BENCHMARK(laboratory_10_s_motors)->Unit(benchmark::kMillisecond);

// Checks the paper's planar arm of eight sections moving to its final position by minimum jerk.
void paper_10_s(benchmark::State& state) {
  constexpr std::array<double, 8> lengths = {2., 3., 1., 2., 4., 2., 1., 1.};
  constexpr std::array<double, 8> archings_pi = {.05, .05, .1, .1, .05, -.3, .2, -.35};
  Arm arm;
  ArmState end = ArmState::straight(8);
  for (std::size_t i = 0; i < 8; ++i) {
    arm.sections.push_back({.length = lengths[i], .max_bend = 3, .max_bend_rate = 1});
    end.bends[i].x() = -2 * archings_pi[i] * std::numbers::pi;
  }
  check(state, arm,
        point_to_point_motion(ArmState::straight(8), end, std::vector(8, Profile::minimum_jerk(duration))),
        {});
}
BENCHMARK(paper_10_s)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
