#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/spatial.h"

// A solve of inverse kinematics for three spatial sections of 0.3, 0.25 and 0.2 m bent up to 120 degrees:
// over the same thousand random reachable targets, from nothing (cold) and from a state whose bends are off
// by up to 0.1 rad (warm), as when a target is followed.
namespace flexura {
namespace {

enum Kind : std::int64_t { position, direction, pose };

struct Question {
  TipTarget target;
  InverseOptions cold;
  InverseOptions warm;
};

// SplitMix64, in [0, 1).
double random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

Arm three_sections() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (const double length : {0.3, 0.25, 0.2}) {
    Section& section = arm.sections.emplace_back();
    section.length = length;
    section.max_bend = 2.0 / 3.0 * std::numbers::pi;
  }
  return arm;
}

std::vector<Question> questions(const Arm& arm, std::int64_t kind) {
  std::uint64_t seed = 1;
  std::vector<Question> result(1000);
  for (Question& question : result) {
    ArmState state = ArmState::straight(3);
    ArmState near = state;
    for (std::size_t i = 0; i < 3; ++i) {
      const double bend = arm.sections[i].max_bend * std::sqrt(random(seed));
      const double angle = 2.0 * std::numbers::pi * random(seed);
      state.bends[i] = {bend * std::cos(angle), bend * std::sin(angle)};
      near.bends[i] = state.bends[i] + 0.2 * Eigen::Vector2d(random(seed) - 0.5, random(seed) - 0.5);
    }
    const Pose X_WT = tip_pose(arm, state);
    question.target.position = X_WT.position;
    if (kind == direction) question.target.direction = X_WT.rotation.col(2);
    if (kind == pose) question.target.rotation = X_WT.rotation;
    question.warm.start = near;
  }
  return result;
}

void solve(benchmark::State& state, bool is_warm) {
  const Arm arm = three_sections();
  const std::vector<Question> all = questions(arm, state.range(0));
  std::size_t next = 0;
  double iterations = 0.0;
  double unsolved = 0.0;
  for (auto _ : state) {
    const Question& question = all[next];
    next = (next + 1) % all.size();
    const InverseResult result = solve_inverse(arm, question.target, is_warm ? question.warm : question.cold);
    iterations += result.iterations;
    unsolved += result.converged() ? 0.0 : 1.0;
    benchmark::DoNotOptimize(result.position_error);
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["unsolved"] = benchmark::Counter(unsolved, benchmark::Counter::kAvgIterations);
}

void inverse_cold(benchmark::State& state) { solve(state, false); }
void inverse_warm(benchmark::State& state) { solve(state, true); }
BENCHMARK(inverse_cold)->ArgName("kind")->Arg(position)->Arg(direction)->Arg(pose);
BENCHMARK(inverse_warm)->ArgName("kind")->Arg(position)->Arg(direction)->Arg(pose);

}  // namespace
}  // namespace flexura
