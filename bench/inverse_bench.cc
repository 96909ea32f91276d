#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <numbers>
#include <vector>

#include "bench/kdl_chain.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/spatial.h"

// A solve of inverse kinematics for three spatial sections of 0.3, 0.25 and 0.2 m bent up to 120 degrees:
// over the same thousand random reachable targets, from nothing (cold) and from a state whose bends are off
// by up to 0.1 rad (warm), as when a target is followed.
namespace flexura {
namespace {

enum Kind : std::int64_t { position, direction, pose };

struct Question {
  ArmState desired, near;
  TipTarget target;
  InverseConfig cold;
  InverseConfig warm;
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
    question.desired = state;
    question.near = near;
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

// Full poses by Orocos KDL's Levenberg-Marquardt on the same arm as a chain of 72 joints, beside the third
// kind above: targets where the chain itself has its tip in the same states, from straight but for 0.1 rad a
// section (cold: exactly straight is singular) and from the same near states (warm), to 1e-9 of the arm's
// length and 1e-9 rad. It has no limits and makes one descent, of up to 500 iterations as by default; ours
// keeps to limits, and tries again. What KDL does not solve is counted, not hidden.
void solve_by_kdl(benchmark::State& state, bool is_warm) {
  const Arm arm = three_sections();
  const std::vector<Question> all = questions(arm, pose);
  const KDL::Chain chain = kdl_chain(arm);
  KDL::ChainFkSolverPos_recursive forward(chain);
  ArmState bent = ArmState::straight(3);
  for (Eigen::Vector2d& bend : bent.bends) bend = {0.08, 0.06};
  std::vector<KDL::Frame> targets;
  std::vector<KDL::JntArray> starts;
  for (const Question& question : all) {
    forward.JntToCart(kdl_joints(arm, question.desired), targets.emplace_back());
    starts.push_back(kdl_joints(arm, is_warm ? question.near : bent));
  }
  // Weights of positions and angles: both in the tolerance's unit.
  Eigen::Matrix<double, 6, 1> weights;
  weights << Eigen::Vector3d::Constant(1.0 / arm.length()), Eigen::Vector3d::Ones();
  KDL::ChainIkSolverPos_LMA solver(chain, weights, 1e-9);
  KDL::JntArray found(chain.getNrOfJoints());
  std::size_t next = 0;
  double iterations = 0.0;
  double unsolved = 0.0;
  for (auto _ : state) {
    const int error = solver.CartToJnt(starts[next], targets[next], found);
    next = (next + 1) % all.size();
    iterations += solver.lastNrOfIter;
    unsolved += error == KDL::SolverI::E_NOERROR ? 0.0 : 1.0;
    benchmark::DoNotOptimize(found.data.data());
  }
  state.counters["joints"] = chain.getNrOfJoints();
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["unsolved"] = benchmark::Counter(unsolved, benchmark::Counter::kAvgIterations);
}

void inverse_kdl_cold(benchmark::State& state) { solve_by_kdl(state, false); }
void inverse_kdl_warm(benchmark::State& state) { solve_by_kdl(state, true); }
BENCHMARK(inverse_kdl_cold);
BENCHMARK(inverse_kdl_warm);

}  // namespace
}  // namespace flexura
