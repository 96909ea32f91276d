#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/math/dense.h"
#include "flexura/mechanics/arc_fit.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/inverse_statics.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm_model.h"
#include "tests/support/known_rods.h"

// Benchmarks of equilibria: from the rod at rest (cold), and from a nearby one (warm). `error_m` is the
// distance of the tip from that of an independent solver. The robots are in tests/support/known_rods.h, the
// values in statics_test.cc.
namespace flexura {
namespace {

struct Case {
  Rod rod;
  TendonInput tendons;
  RodLoads loads;
  Eigen::Vector3d tip;
};

// Returns a known case: tendons alone; with a force; a heavy rod with one tendon.
Case known_case(std::int64_t which) {
  Case known{.rod = two_section_robot(), .tendons = {}, .loads = {}, .tip = {}};
  if (which == 0) {
    known.tendons.tensions = {4, 0, 0, 0, 2, 0};
    known.tip = {0.127607603, 0.143467423, 0.336406799};
  } else if (which == 1) {
    known.loads.ends = {{.section = 1, .force = {0.1, 0, 0}}};
    known.tip = {0.169688740, 0, 0.353786806};
  } else {
    known.rod = heavy_rod();
    known.tendons.tensions = {15};
    known.loads.gravity = {9.81, 0, 0};
    known.tip = {0.182211695, 0, 0.453229271};
  }
  // With these modes each case's error is below a micrometre.
  for (RodSection& section : known.rod.sections)
    section.modes = {.shear = 1, .stretch = 1, .bend = 4, .twist = 2};
  return known;
}

void statics_cold(benchmark::State& state) {
  const Case known = known_case(state.range(0));
  RodStatics statics(known.rod);
  Equilibrium at;
  for (auto _ : state) {
    at = statics.solve(known.tendons, known.loads);
    benchmark::DoNotOptimize(at);
  }
  state.counters["error_m"] = (at.tip.position - known.tip).norm();
}
BENCHMARK(statics_cold)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

void statics_warm(benchmark::State& state) {
  const Case known = known_case(state.range(0));
  RodStatics statics(known.rod);
  const Equilibrium first = statics.solve(known.tendons, known.loads);
  Equilibrium at = first;
  Case other = known;
  for (double& tension : other.tendons.tensions) tension *= 1.001;
  for (EndLoad& end : other.loads.ends) end.force *= 1.001;
  bool there = false;
  for (auto _ : state) {
    const Case& to = there ? known : other;
    at = statics.solve(to.tendons, to.loads, at);
    benchmark::DoNotOptimize(at);
    there = !there;
  }
}
BENCHMARK(statics_warm)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

// The two-section robot with prescribed displacements of its tendons, whose compliance is 0.1 mm/N.
void statics_displacements(benchmark::State& state) {
  Rod rod = known_case(0).rod;
  for (TendonRoute& tendon : rod.tendons) tendon.compliance = 1e-4;
  RodStatics statics(rod);
  const TendonInput pulled{.displacements = {0.004, -0.002, -0.002, 0.004, 0.002, -0.006}};
  for (auto _ : state) benchmark::DoNotOptimize(statics.solve(pulled, {}));
}
BENCHMARK(statics_displacements)->Unit(benchmark::kMicrosecond);

// A heavy arm with this number of sections and a tendon to the end of each, warm. Shows how the cost grows
// with the number of sections.
void statics_sections(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  Rod rod;
  RodSection section{.length = 1.0 / static_cast<double>(count),
                     .radius = {2e-3, 2e-3},
                     .youngs_modulus = 54e9,
                     .shear_modulus = 20e9,
                     .density = 6000};
  section.modes = {.shear = 1, .stretch = 1, .bend = 2, .twist = 1};
  rod.sections.assign(count, section);
  rod.tendons = {{.section = count - 1, .radius = 0.01, .angle = 0.3}};
  RodStatics statics(rod);
  const RodLoads weight{.gravity = {0, -9.81, 0}};
  Equilibrium at = statics.solve({.tensions = {10}}, weight);
  double tension = 10;
  for (auto _ : state) {
    tension = tension == 10 ? 10.01 : 10;
    at = statics.solve({.tensions = {tension}}, weight, at);
    benchmark::DoNotOptimize(at);
  }
  state.counters["us_a_section"] =
      benchmark::Counter(static_cast<double>(count) * 1e-6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(statics_sections)->ArgsProduct({{1, 2, 5, 10, 20, 50, 100}})->Unit(benchmark::kMicrosecond);

// Three sections of five pieces between guide disks, nine tendons; cold or warm. By piece, or with modes of
// whole sections.
struct Disks {
  explicit Disks(bool by_piece) {
    RodSection section{.length = 0.15,
                       .radius = {1e-3, 1e-3},
                       .youngs_modulus = 54e9,
                       .shear_modulus = 20e9,
                       .density = 6000,
                       .disks = 5};
    section.modes.by_piece = by_piece;
    rod.sections.assign(3, section);
    for (std::size_t i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        rod.tendons.push_back({.section = i,
                               .radius = 0.01,
                               .angle = (k + static_cast<double>(i) / 3) * 2 * std::numbers::pi / 3});
  }
  [[nodiscard]] static TendonInput tendons(double factor) {
    return {.tensions = {3 * factor, 0, 0, 0, 2.5 * factor, 0, 2 * factor, 0, 0.5}};
  }
  Rod rod;
  RodLoads weight{.gravity = {0, 0, -9.81}};
};

void statics_disks_cold(benchmark::State& state) {
  const Disks robot(state.range(0) == 1);
  RodStatics statics(robot.rod);
  for (auto _ : state) benchmark::DoNotOptimize(statics.solve(Disks::tendons(1), robot.weight));
}
BENCHMARK(statics_disks_cold)->ArgName("by_piece")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void statics_disks_warm(benchmark::State& state) {
  const Disks robot(state.range(0) == 1);
  RodStatics statics(robot.rod);
  Equilibrium at = statics.solve(Disks::tendons(1), robot.weight);
  bool there = false;
  for (auto _ : state) {
    at = statics.solve(Disks::tendons(there ? 1 : 1.001), robot.weight, at);
    benchmark::DoNotOptimize(at);
    there = !there;
  }
}
BENCHMARK(statics_disks_warm)->ArgName("by_piece")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// Steps of 5 ms of the same robot, damped, under tensions that swing.
void dynamics_disks(benchmark::State& state) {
  Disks robot(state.range(0) == 1);
  for (RodSection& section : robot.rod.sections) section.damping_time = 0.02;
  RodDynamics dynamics(robot.rod);
  RodState at = dynamics.rest();
  int k = 0;
  for (auto _ : state) {
    const double factor = 0.5 - 0.5 * std::cos(0.02 * k++);
    benchmark::DoNotOptimize(dynamics.step(at, Disks::tendons(factor), robot.weight, 5e-3));
  }
}
BENCHMARK(dynamics_disks)->ArgName("by_piece")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// Tensions of least effort for tips near that of tensions 4 0 0 0 2 0. Starts from rest (0), or from the
// previous solution (1).
void inverse_statics(benchmark::State& state) {
  const Case known = known_case(0);
  RodStatics statics(known.rod);
  const std::vector<double> most(known.rod.tendons.size(), 10);
  InverseStaticsConfig config;
  InverseStaticsResult result;
  double evaluations = 0;
  bool there = false;
  for (auto _ : state) {
    const Eigen::Vector3d beside = known.tip + Eigen::Vector3d(there ? 1e-3 : 0, -2e-3, 0);
    result = solve_inverse_statics(statics, {.position = beside}, {}, most, config);
    evaluations += result.evaluations;
    if (state.range(0) == 1) config.start = result.equilibrium;
    there = !there;
  }
  state.counters["error_m"] = result.position_error;
  state.counters["equilibria"] = benchmark::Counter(evaluations, benchmark::Counter::kAvgIterations);
}
BENCHMARK(inverse_statics)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// A step of the fit of arcs to places along them, four on each arc: by elimination arc by arc (0), and by
// dense normal equations (1), as an independent reference whose result it must agree with.
void fit_of_arcs(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(count);
  for (Section& section : arm.sections) section.length = 1 / static_cast<double>(count);
  const ArmVariables variables(arm);
  std::vector<MaterialPoint> places;
  for (std::size_t k = 0; k < count; ++k)
    for (const double at : {0.25, 0.5, 0.75, 1.0}) places.push_back({k, at});
  const auto rows = 3 * static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd moved(rows, 1), J(rows, variables.size());
  for (Eigen::Index i = 0; i < rows; ++i) moved(i, 0) = 1e-3 * std::sin(static_cast<double>(i));
  ArmState shape = ArmState::straight(count);
  for (Eigen::Vector2d& bend : shape.bends) bend = Eigen::Vector2d(2, 1) / static_cast<double>(count);
  const auto dense = [&]() -> Eigen::VectorXd {
    const BackboneJacobian jacobian(arm, shape);
    Jacobian columns(6, 3 * static_cast<Eigen::Index>(count));
    for (std::size_t p = 0; p < places.size(); ++p) {
      jacobian.at(places[p], columns);
      for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(count); ++k)
        J.block<3, 2>(3 * static_cast<Eigen::Index>(p), 2 * k) = columns.block<3, 2>(0, 3 * k);
    }
    return PivotedCholesky(J.transpose() * J).solve(J.transpose() * moved);
  };
  ArcFit fit(variables, places);
  const auto by_arcs = [&]() -> Eigen::VectorXd {
    fit.set(arm, shape);
    return fit.solve(moved);
  };
  for (auto _ : state) {
    if (state.range(1) != 0)
      benchmark::DoNotOptimize(dense());
    else
      benchmark::DoNotOptimize(by_arcs());
  }
  state.counters["difference"] = (by_arcs() - dense()).norm() / dense().norm();
}
BENCHMARK(fit_of_arcs)
    ->ArgNames({"arcs", "dense"})
    ->ArgsProduct({{9, 30, 90}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

// Shapes of an arm whose model is an elastic rod, under commands that change: an equilibrium, and the arcs
// nearest to it. `arcs` is the number of arcs of each section. Shows how the cost grows with the sections.
void shape_of_rod(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0)),
             arcs = static_cast<std::size_t>(state.range(1));
  ArmConfig arm;
  arm.kind = ArmKind::spatial;
  arm.mechanics = ArmMechanics::statics;
  arm.gravity = {0, -9.81, 0};
  arm.section.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Section& section = arm.section[i];
    section.length = 0.6 / static_cast<double>(count);
    section.bend_profile.emplace(arcs, 1.0);
    section.material = MaterialConfig{.youngs_modulus = 2.5e6,
                                      .poisson = 0.49,
                                      .density = 1070,
                                      .radius = std::array{0.015, 0.015},
                                      .modes = {.shear = 0, .stretch = 1, .bend = 2, .twist = 1}};
    for (int t = 0; t < 3; ++t)
      arm.tendon.push_back({.section = static_cast<int>(i) + 1,
                            .radius = 0.011,
                            .angle = (120 * t + 7 * static_cast<double>(i)) * std::numbers::pi / 180,
                            .compliance = 1e-4});
  }
  const ArmModel model = arm_model_of(arm, std::nullopt);
  const bool has_slopes = state.range(2) != 0;
  ArmState command = ArmState::straight(count);
  Eigen::MatrixXd slopes;
  double more = 0;
  for (auto _ : state) {
    more = more < 0.1 ? more + 0.01 : 0;
    for (Eigen::Vector2d& bend : command.bends)
      bend = Eigen::Vector2d(1 + more, 0.5 - more) / static_cast<double>(count);
    benchmark::DoNotOptimize(model.actuation().shape(command));
    if (has_slopes) model.actuation().slopes(command, slopes);
  }
  state.counters["us_a_section"] =
      benchmark::Counter(static_cast<double>(count) * 1e-6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(shape_of_rod)
    ->ArgNames({"sections", "arcs", "slopes"})
    ->ArgsProduct({{3, 10, 30}, {3}, {0, 1}})
    ->ArgsProduct({{1}, {6, 60}, {0}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexura
