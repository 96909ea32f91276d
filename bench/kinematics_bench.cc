#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "bench/kdl_chain.h"
#include "flexura/kinematics/curves.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/planar.h"
#include "flexura/kinematics/spatial.h"

// Benchmarks of forward kinematics, one arm a call, and the same curve in Orocos KDL. All use the same
// thousand random states, with bends uniform in +-2 rad in each direction.
namespace flexura {
namespace {

constexpr std::size_t count = 1000;
using std::numbers::pi;

// Returns a random number in [low, high) (SplitMix64).
double random(std::uint64_t& state, double low, double high) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return low + (high - low) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

struct Case {
  Arm arm;
  std::vector<ArmState> states;
};

Case make_case(ArmKind kind, const std::vector<double>& lengths, bool stretches) {
  Case result;
  result.arm.kind = kind;
  for (const double length : lengths) result.arm.sections.emplace_back().length = length;
  std::uint64_t seed = 1;
  result.states.assign(count, ArmState::straight(lengths.size()));
  for (ArmState& state : result.states) {
    for (Eigen::Vector2d& bend : state.bends)
      bend = {random(seed, -2, 2), kind == ArmKind::spatial ? random(seed, -2, 2) : 0.0};
    if (!stretches) continue;
    for (double& stretch : state.stretches) stretch = random(seed, 0.8, 1.2);
  }
  return result;
}

Case planar_case() { return make_case(ArmKind::planar, {2., 3., 1., 2., 4., 2., 1., 1.}, false); }
Case spatial_case(bool stretches) { return make_case(ArmKind::spatial, {0.3, 0.25, 0.2}, stretches); }

// Calls body(index of a state) repeatedly.
template <typename Body>
void one_by_one(benchmark::State& state, Body&& body) {
  std::size_t next = 0;
  for (auto _ : state) {
    body(next);
    benchmark::ClobberMemory();
    next = (next + 1) % count;
  }
}

void tip_of_3_sections(benchmark::State& state) {
  const Case c = spatial_case(true);
  one_by_one(state, [&](std::size_t i) { benchmark::DoNotOptimize(tip_pose(c.arm, c.states[i])); });
}
BENCHMARK(tip_of_3_sections);

// Computes the tip's pose and its Jacobian, 6 x 9.
void jacobian_of_3_sections(benchmark::State& state) {
  const Case c = spatial_case(true);
  BackboneJacobian backbone;
  Jacobian J(6, 9);
  one_by_one(state, [&](std::size_t i) {
    backbone.set(c.arm, c.states[i]);
    backbone.tip(J);
    benchmark::DoNotOptimize(J.data());
  });
}
BENCHMARK(jacobian_of_3_sections);

// Computes the Jacobians of 100 points along the arm.
void jacobians_along_3_sections(benchmark::State& state) {
  const Case c = spatial_case(true);
  std::vector<MaterialPoint> points;
  for (int i = 0; i < 100; ++i) points.push_back(material_point(c.arm, c.arm.length() * i / 99));
  BackboneJacobian backbone;
  Jacobian J(6, 9);
  one_by_one(state, [&](std::size_t i) {
    backbone.set(c.arm, c.states[i]);
    for (const MaterialPoint& point : points) {
      backbone.at(point, J);
      benchmark::DoNotOptimize(J.data());
    }
  });
}
BENCHMARK(jacobians_along_3_sections);

void backbone_of_3_sections(benchmark::State& state) {
  const Case c = spatial_case(true);
  one_by_one(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(Backbone(c.arm, c.states[i]).tip().position.x());
  });
}
BENCHMARK(backbone_of_3_sections);

void points_of_8_sections(benchmark::State& state) {
  const Case c = planar_case();
  std::vector<double> lengths, archings;
  for (const Section& section : c.arm.sections) lengths.push_back(section.length);
  for (const ArmState& s : c.states) {
    for (const Eigen::Vector2d& bend : s.bends) archings.push_back(arching_from_bend(bend));
  }
  one_by_one(state, [&](std::size_t i) {
    const std::span<const double> own(archings.data() + 8 * i, 8);
    benchmark::DoNotOptimize(base_points(lengths, own, {0.0, 0.0}, pi / 2));
  });
}
BENCHMARK(points_of_8_sections);

void bezier_of_8_sections(benchmark::State& state) {
  const Case c = planar_case();
  one_by_one(state,
             [&](std::size_t i) { benchmark::DoNotOptimize(tangent_bezier(Backbone(c.arm, c.states[i]))); });
}
BENCHMARK(bezier_of_8_sections);

struct KdlCase {
  KDL::Chain chain;
  std::vector<KDL::JntArray> states;
};

KdlCase kdl_case(const Case& c) {
  KdlCase result{.chain = kdl_chain(c.arm), .states = {}};
  for (const ArmState& s : c.states) result.states.push_back(kdl_joints(c.arm, s));
  return result;
}

// Returns the largest distance of KDL's tips from the arcs' ends, relative to the arm's length: checks that
// both are the same curve.
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
  one_by_one(state, [&](std::size_t i) { benchmark::DoNotOptimize(solver.JntToCart(kdl.states[i], tip)); });
  state.counters["joints"] = kdl.chain.getNrOfJoints();
  state.counters["deviation"] = largest_deviation(c, kdl);
}
void tip_of_3_sections_kdl(benchmark::State& state) { forward_kdl(state, spatial_case(false)); }
BENCHMARK(tip_of_3_sections_kdl);
void points_of_8_sections_kdl(benchmark::State& state) { forward_kdl(state, planar_case()); }
BENCHMARK(points_of_8_sections_kdl);

// Computes the tip's pose and its Jacobian, 6 x 72.
void jacobian_of_3_sections_kdl(benchmark::State& state) {
  const KdlCase kdl = kdl_case(spatial_case(false));
  KDL::ChainFkSolverPos_recursive forward(kdl.chain);
  KDL::ChainJntToJacSolver solver(kdl.chain);
  KDL::Jacobian J(kdl.chain.getNrOfJoints());
  KDL::Frame tip;
  one_by_one(state, [&](std::size_t i) {
    benchmark::DoNotOptimize(forward.JntToCart(kdl.states[i], tip));
    benchmark::DoNotOptimize(solver.JntToJac(kdl.states[i], J));
  });
}
BENCHMARK(jacobian_of_3_sections_kdl);

}  // namespace
}  // namespace flexura
