#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "flexura/kinematics/curves.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/planar.h"
#include "flexura/kinematics/sampling.h"
#include "flexura/kinematics/spatial.h"

namespace flexura {
namespace {

// The paper's arm in its final position.
constexpr std::array<double, 8> paper_lengths = {2., 3., 1., 2., 4., 2., 1., 1.};
using std::numbers::pi;
constexpr std::array<double, 8> paper_archings = {.05 * pi, .05 * pi, .1 * pi, .1 * pi,
                                                  .05 * pi, -.3 * pi, .2 * pi, -.35 * pi};

struct Case {
  Arm arm;
  ArmState state;
};

Case paper_arm() {
  Case result;
  result.state = ArmState::straight(paper_lengths.size());
  for (std::size_t i = 0; i < paper_lengths.size(); ++i) {
    result.arm.sections.emplace_back().length = paper_lengths[i];
    result.state.bends[i] = bend_from_arching(paper_archings[i]);
  }
  return result;
}

Case spatial_arm() {
  Case result;
  result.arm.kind = ArmKind::spatial;
  result.state = ArmState::straight(3);
  for (std::size_t i = 0; i < 3; ++i) {
    result.arm.sections.emplace_back().length = 0.3;
    result.state.bends[i] = {0.4 + 0.3 * static_cast<double>(i), -0.7};
  }
  return result;
}

void planar_forward_8_sections(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(base_points(paper_lengths, paper_archings, {0.0, 0.0}, pi / 2));
  }
}
BENCHMARK(planar_forward_8_sections);

void spatial_forward_3_sections(benchmark::State& state) {
  const Case c = spatial_arm();
  std::vector<Pose> frames(4);
  for (auto _ : state) {
    section_frames(c.arm, c.state, frames);
    benchmark::DoNotOptimize(frames.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(spatial_forward_3_sections);

void backbone_of_3_sections(benchmark::State& state) {
  const Case c = spatial_arm();
  for (auto _ : state) benchmark::DoNotOptimize(Backbone(c.arm, c.state).tip().position.x());
}
BENCHMARK(backbone_of_3_sections);

void tip_jacobian_3_sections(benchmark::State& state) {
  const Case c = spatial_arm();
  for (auto _ : state) benchmark::DoNotOptimize(tip_jacobian(c.arm, c.state));
}
BENCHMARK(tip_jacobian_3_sections);

// 100 points along the arm.
void backbone_jacobians_3_sections(benchmark::State& state) {
  const Case c = spatial_arm();
  std::vector<MaterialPoint> points;
  points.reserve(100);
  for (int i = 0; i < 100; ++i) points.push_back(material_point(c.arm, c.arm.length() * i / 99));
  Jacobian J(6, 9);
  for (auto _ : state) {
    const BackboneJacobian jacobian(c.arm, c.state);
    for (const MaterialPoint& point : points) {
      jacobian.at(point, J);
      benchmark::DoNotOptimize(J.data());
    }
  }
}
BENCHMARK(backbone_jacobians_3_sections);

// Positions to a tolerance of 10^-n m.
void sampling_8_sections(benchmark::State& state) {
  const Case c = paper_arm();
  const Backbone backbone(c.arm, c.state);
  const double tolerance = std::pow(10.0, -static_cast<double>(state.range(0)));
  std::size_t points = 0;
  for (auto _ : state) {
    const std::vector<double> s = sample_arc_lengths(backbone, tolerance);
    benchmark::DoNotOptimize(poses_at(backbone, s));
    points = s.size();
  }
  state.counters["points"] = static_cast<double>(points);
}
BENCHMARK(sampling_8_sections)->Arg(2)->Arg(4)->Arg(6);

void tangent_bezier_8_sections(benchmark::State& state) {
  const Case c = paper_arm();
  const Backbone backbone(c.arm, c.state);
  for (auto _ : state) benchmark::DoNotOptimize(tangent_bezier(backbone));
}
BENCHMARK(tangent_bezier_8_sections);

}  // namespace
}  // namespace flexura
