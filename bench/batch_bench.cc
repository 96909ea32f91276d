#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "bench/kdl_chain.h"
#include "flexura/kinematics/batch.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/planar.h"
#include "flexura/kinematics/sampling.h"
#include "flexura/kinematics/spatial.h"

// How many arms a second, one at a time, in batches on every path, and by Orocos KDL; beside them how many
// sines and cosines. items_per_second counts arms, or pairs of sine and cosine. All go over the same thousand
// random states, bends uniform in +-2 rad in each direction.
namespace flexura {
namespace {

constexpr std::size_t count = 1000;
using std::numbers::pi;

// SplitMix64, in [0, 1).
double random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

std::vector<double> random_numbers(std::size_t size, double low, double high) {
  std::uint64_t seed = 1;
  std::vector<double> numbers(size);
  for (double& number : numbers) number = low + (high - low) * random(seed);
  return numbers;
}

// One arm, and the states of a thousand as a batch and one by one.
struct Case {
  Arm arm;
  std::vector<double> bend_x, bend_y, stretch;
  std::vector<ArmState> states;

  [[nodiscard]] BatchStates batch() const { return {count, bend_x, bend_y, stretch}; }
};

Case make_case(ArmKind kind, const std::vector<double>& lengths, bool stretches) {
  Case result;
  result.arm.kind = kind;
  for (const double length : lengths) result.arm.sections.emplace_back().length = length;
  const std::size_t size = lengths.size() * count;
  std::vector<double> bends = random_numbers(2 * size, -2.0, 2.0);
  result.bend_x.assign(bends.begin(), bends.begin() + static_cast<std::ptrdiff_t>(size));
  if (kind == ArmKind::spatial)
    result.bend_y.assign(bends.end() - static_cast<std::ptrdiff_t>(size), bends.end());
  if (stretches) result.stretch = random_numbers(size, 0.8, 1.2);
  result.states.assign(count, ArmState::straight(lengths.size()));
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t at = i * count + j;
      result.states[j].bends[i] = {result.bend_x[at], kind == ArmKind::spatial ? result.bend_y[at] : 0.0};
      if (stretches) result.states[j].stretches[i] = result.stretch[at];
    }
  }
  return result;
}

Case planar_case() { return make_case(ArmKind::planar, {2., 3., 1., 2., 4., 2., 1., 1.}, false); }
Case spatial_case(bool stretches) { return make_case(ArmKind::spatial, {0.3, 0.25, 0.2}, stretches); }

void count_items(benchmark::State& state, std::size_t items_each) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items_each));
}

// Registers a benchmark once for each path, as NAME/PATH.
template <typename Function>
void register_paths(const std::string& name, Function function) {
  for (const SimdPath path : available_simd_paths()) {
    const std::string full_name = name + "/" + std::string(name_of(path));
    benchmark::RegisterBenchmark(full_name.c_str(),
                                 [function, path](benchmark::State& state) { function(state, path); });
  }
}

// --- The bound
// ------------------------------------------------------------------------------------------------

void sincos_std(benchmark::State& state) {
  const std::vector<double> angles = random_numbers(count, -pi, pi);
  std::vector<double> sines(count), cosines(count);
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) {
      sines[i] = std::sin(angles[i]);
      cosines[i] = std::cos(angles[i]);
    }
    benchmark::ClobberMemory();
  }
  count_items(state, count);
}
BENCHMARK(sincos_std);

void sincos_batch(benchmark::State& state, SimdPath path) {
  const std::vector<double> angles = random_numbers(count, -pi, pi);
  std::vector<double> sines(count), cosines(count);
  for (auto _ : state) {
    sines_and_cosines(angles, sines, cosines, path);
    benchmark::ClobberMemory();
  }
  count_items(state, count);
}

// --- Planar arms of 8 sections: base points and end effector
// ---------------------------------------------------

void planar_single(benchmark::State& state) {
  const Case c = planar_case();
  std::vector<double> lengths, archings;
  for (const Section& section : c.arm.sections) lengths.push_back(section.length);
  for (const ArmState& s : c.states) {
    for (const Eigen::Vector2d& bend : s.bends) archings.push_back(arching_from_bend(bend));
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const std::span<const double> own(archings.data() + 8 * next, 8);
    next = (next + 1) % count;
    benchmark::DoNotOptimize(base_points(lengths, own, {0.0, 0.0}, pi / 2));
  }
  count_items(state, 1);
}
BENCHMARK(planar_single);

void planar_batch(benchmark::State& state, SimdPath path) {
  const Case c = planar_case();
  const BatchKinematics kinematics(c.arm, path);
  std::vector<double> points(27 * count);
  for (auto _ : state) {
    kinematics.base_points(c.batch(), points);
    benchmark::ClobberMemory();
  }
  count_items(state, count);
}

// --- Spatial arms of 3 sections: the tip's pose
// ----------------------------------------------------------------

// Calls body(state of an arm) over and over.
template <typename Body>
void one_by_one(benchmark::State& state, const Case& c, Body&& body) {
  std::size_t next = 0;
  for (auto _ : state) {
    body(c.states[next]);
    next = (next + 1) % count;
  }
  count_items(state, 1);
}

void spatial_single_tip_pose(benchmark::State& state) {
  const Case c = spatial_case(true);
  one_by_one(state, c, [&c](const ArmState& s) { benchmark::DoNotOptimize(tip_pose(c.arm, s)); });
}
BENCHMARK(spatial_single_tip_pose);

void spatial_single_kinematics(benchmark::State& state) {
  const Case c = spatial_case(true);
  const BatchKinematics kinematics(c.arm);
  one_by_one(state, c, [&](const ArmState& s) { benchmark::DoNotOptimize(kinematics.tip(s)); });
}
BENCHMARK(spatial_single_kinematics);

void spatial_batch(benchmark::State& state, SimdPath path) {
  const Case c = spatial_case(true);
  const BatchKinematics kinematics(c.arm, path);
  std::vector<double> tips(12 * count);
  for (auto _ : state) {
    kinematics.tips(c.batch(), tips);
    benchmark::ClobberMemory();
  }
  count_items(state, count);
}

// --- The same with the tip's Jacobian, 6 x 9
// -------------------------------------------------------------------

void jacobian_single_tip_jacobian(benchmark::State& state) {
  const Case c = spatial_case(true);
  one_by_one(state, c, [&c](const ArmState& s) { benchmark::DoNotOptimize(tip_jacobian(c.arm, s)); });
}
BENCHMARK(jacobian_single_tip_jacobian);

void jacobian_single_kinematics(benchmark::State& state) {
  const Case c = spatial_case(true);
  const BatchKinematics kinematics(c.arm);
  Jacobian J(6, 9);
  one_by_one(state, c, [&](const ArmState& s) {
    benchmark::DoNotOptimize(kinematics.tip_jacobian(s, J));
    benchmark::ClobberMemory();
  });
}
BENCHMARK(jacobian_single_kinematics);

void jacobian_batch(benchmark::State& state, SimdPath path, bool stretches) {
  const Case c = spatial_case(stretches);
  const BatchKinematics kinematics(c.arm, path);
  std::vector<double> tips(12 * count);
  std::vector<double> jacobians(6 * kinematics.jacobian_columns(c.batch()) * count);
  for (auto _ : state) {
    kinematics.tip_jacobians(c.batch(), tips, jacobians);
    benchmark::ClobberMemory();
  }
  count_items(state, count);
}

// --- The same curve in Orocos KDL
// ------------------------------------------------------------------------------

struct KdlCase {
  KDL::Chain chain;
  std::vector<KDL::JntArray> states;
};

KdlCase kdl_case(const Case& c) {
  KdlCase result{.chain = kdl_chain(c.arm), .states = {}};
  for (const ArmState& s : c.states) result.states.push_back(kdl_joints(c.arm, s));
  return result;
}

// How far KDL's tips are from the arcs' ends, in parts of the arm's length: that it is the same curve.
double largest_deviation(const Case& c, const KdlCase& kdl) {
  KDL::ChainFkSolverPos_recursive solver(kdl.chain);
  Arm arm = c.arm;
  arm.X_WB = Pose{};
  double largest = 0.0;
  for (std::size_t j = 0; j < count; ++j) {
    KDL::Frame tip;
    solver.JntToCart(kdl.states[j], tip);
    const Eigen::Vector3d p(tip.p.x(), tip.p.y(), tip.p.z());
    largest = std::max(largest, (p - tip_pose(arm, c.states[j]).position).norm() / arm.length());
  }
  return largest;
}

void forward_kdl(benchmark::State& state, const Case& c) {
  const KdlCase kdl = kdl_case(c);
  KDL::ChainFkSolverPos_recursive solver(kdl.chain);
  KDL::Frame tip;
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver.JntToCart(kdl.states[next], tip));
    benchmark::ClobberMemory();
    next = (next + 1) % count;
  }
  count_items(state, 1);
  state.counters["joints"] = kdl.chain.getNrOfJoints();
  state.counters["deviation"] = largest_deviation(c, kdl);
}
void planar_kdl(benchmark::State& state) { forward_kdl(state, planar_case()); }
BENCHMARK(planar_kdl);
void spatial_kdl(benchmark::State& state) { forward_kdl(state, spatial_case(false)); }
BENCHMARK(spatial_kdl);

// The tip's pose and its Jacobian, 6 x 72.
void jacobian_kdl(benchmark::State& state) {
  const KdlCase kdl = kdl_case(spatial_case(false));
  KDL::ChainFkSolverPos_recursive forward(kdl.chain);
  KDL::ChainJntToJacSolver solver(kdl.chain);
  KDL::Jacobian J(kdl.chain.getNrOfJoints());
  KDL::Frame tip;
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(forward.JntToCart(kdl.states[next], tip));
    benchmark::DoNotOptimize(solver.JntToJac(kdl.states[next], J));
    benchmark::ClobberMemory();
    next = (next + 1) % count;
  }
  count_items(state, 1);
}
BENCHMARK(jacobian_kdl);

// The frames of all links: the points that KDL has along the same arm, beside sampling_3_sections.
void sampling_kdl(benchmark::State& state) {
  const KdlCase kdl = kdl_case(spatial_case(false));
  KDL::ChainFkSolverPos_recursive solver(kdl.chain);
  std::vector<KDL::Frame> frames(kdl.chain.getNrOfSegments());
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver.JntToCart(kdl.states[next], frames));
    benchmark::ClobberMemory();
    next = (next + 1) % count;
  }
  count_items(state, 1);
  state.counters["points"] = static_cast<double>(frames.size());
}
BENCHMARK(sampling_kdl);

// --- Sampling: poses along one spatial arm of 3 sections, polyline within 1e-4 m
// --------------------------------

void sampling_3_sections(benchmark::State& state) {
  const Case c = spatial_case(false);
  std::size_t points = 0;
  one_by_one(state, c, [&](const ArmState& s) {
    const Backbone backbone(c.arm, s);
    const std::vector<double> at = sample_arc_lengths(backbone, 1e-4);
    benchmark::DoNotOptimize(poses_at(backbone, at));
    points += at.size();
  });
  state.SetItemsProcessed(static_cast<std::int64_t>(points));
}
BENCHMARK(sampling_3_sections);

const int registered = [] {
  register_paths("sincos_batch", sincos_batch);
  register_paths("planar_batch", planar_batch);
  register_paths("spatial_batch", spatial_batch);
  register_paths("jacobian_batch",
                 [](benchmark::State& state, SimdPath path) { jacobian_batch(state, path, true); });
  register_paths("jacobian_batch_without_stretch",
                 [](benchmark::State& state, SimdPath path) { jacobian_batch(state, path, false); });
  return 0;
}();

}  // namespace
}  // namespace flexura
