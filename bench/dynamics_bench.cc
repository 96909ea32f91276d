#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bench/mujoco_rod.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_contact.h"
#include "tests/support/known_rods.h"

#ifdef FLEXURA_HAS_DART
#include "bench/dart_rod.h"
#endif

// Benchmarks of rod dynamics: half a second of a soft tentacle that falls from a straight, level start.
// `error_mm` is the larger of the tip's errors after 0.25 and 0.5 s. `times_real` is simulated time over CPU
// time. With bends alone the reference tip is that of an independent solver (tests/support/known_rods.h).
// Otherwise it is that of the same rod with more modes and shorter steps.
namespace flexura {
namespace {

constexpr double until = 0.5;  // s

using Tips = std::array<Eigen::Vector3d, 2>;

const Tips falling_tips = {Eigen::Vector3d(-0.352721, 0, 0.467438), Eigen::Vector3d(-0.519303, 0, 0.078858)};

void count(benchmark::State& state, double seconds, const Tips& found, const Tips& known) {
  state.counters["error_mm"] = 1e3 * std::max((found[0] - known[0]).norm(), (found[1] - known[1]).norm());
  state.counters["times_real"] = benchmark::Counter(seconds, benchmark::Counter::kIsIterationInvariantRate);
}

// A run of half a second, which gives the tip's position in the middle and at the end.
struct Fall {
  Rod rod;
  RodDynamicsConfig config;
  TendonInput tendons;
  double step = 0.01;
  std::optional<RodContactConfig> contact = {};

  void run(RodDynamics& dynamics, Tips& tips) const {
    const RodLoads weight = soft_tentacle_weight();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(dynamics.chain().size());
    RodState state = dynamics.start(none, none, tendons, weight);
    const long steps = std::lround(until / step);
    for (long i = 0; i < steps; ++i) {
      if (i == steps / 2) tips[0] = dynamics.tip(state).position;
      benchmark::DoNotOptimize(dynamics.step(state, tendons, weight, step));
    }
    tips[1] = dynamics.tip(state).position;
  }
  // The dynamics with their contacts, if any.
  struct Moving {
    RodDynamics dynamics;
    std::optional<RodContact> contact;

    explicit Moving(const Fall& fall) : dynamics(fall.rod, fall.config) {
      if (!fall.contact) return;
      contact.emplace(dynamics.chain(), *fall.contact);
      dynamics.set_surroundings(&*contact);
    }
  };
  [[nodiscard]] Tips tips() const {
    Moving moving(*this);
    Tips result;
    run(moving.dynamics, result);
    return result;
  }
};

void bench_fall(benchmark::State& state, const Fall& fall, const Tips& known) {
  Fall::Moving moving(fall);
  Tips tips;
  for (auto _ : state) fall.run(moving.dynamics, tips);
  count(state, until, tips, known);
}

// Returns the falling tentacle with these numbers of steps and nodes.
Fall falling_tentacle(std::int64_t steps, std::int64_t nodes) {
  Fall fall{.rod = soft_tentacle(), .config = {.spectral_radius = 0.8, .tolerance = 1e-3}, .tendons = {}};
  fall.rod.sections[0].nodes = static_cast<int>(nodes);
  fall.step = until / static_cast<double>(steps);
  return fall;
}

void fall_bends(benchmark::State& state) {
  bench_fall(state, falling_tentacle(state.range(0), state.range(1)), falling_tips);
}
BENCHMARK(fall_bends)
    ->ArgNames({"steps", "nodes"})
    ->Args({24, 4})
    ->Args({40, 5})
    ->Args({50, 5})
    ->Args({100, 5})
    ->Args({200, 6})
    ->Unit(benchmark::kMicrosecond);

// The same fall with MuJoCo: 24 joints in each direction.
void fall_mujoco(benchmark::State& state) {
  const Rod rod = soft_tentacle();
  const double step = until / static_cast<double>(state.range(1));
  MujocoRod peer(rod.sections[0], soft_tentacle_weight().gravity, 24,
                 static_cast<MujocoIntegrator>(state.range(0)), step);
  const long steps = std::lround(until / step);
  Tips tips;
  for (auto _ : state) {
    peer.reset();
    for (long i = 0; i < steps; ++i) {
      if (i == steps / 2) tips[0] = peer.tip();
      peer.step();
    }
    tips[1] = peer.tip();
  }
  count(state, until, tips, falling_tips);
}
BENCHMARK(fall_mujoco)
    ->ArgNames({"integrator", "steps"})
    ->Args({0, 100})
    ->Args({0, 300})
    ->Args({0, 1000})
    ->Args({1, 100})
    ->Args({1, 300})
    ->Args({1, 1000})
    ->Unit(benchmark::kMicrosecond);

#ifdef FLEXURA_HAS_DART
// The same fall with DART: 24 universal joints.
void fall_dart(benchmark::State& state) {
  const Rod rod = soft_tentacle();
  const double step = until / static_cast<double>(state.range(0));
  DartRod peer(rod.sections[0], soft_tentacle_weight().gravity, 24, step);
  const long steps = std::lround(until / step);
  Tips tips;
  for (auto _ : state) {
    peer.reset();
    for (long i = 0; i < steps; ++i) {
      if (i == steps / 2) tips[0] = peer.tip();
      peer.step();
    }
    tips[1] = peer.tip();
  }
  count(state, until, tips, falling_tips);
}
BENCHMARK(fall_dart)->ArgName("steps")->Arg(100)->Arg(300)->Arg(1000)->Unit(benchmark::kMicrosecond);
#endif

const Tips& converged(const Fall& fall, int extra) {
  static std::map<int, Tips> known;
  if (const auto found = known.find(extra); found != known.end()) return found->second;
  Fall fine = fall;
  RodSection& section = fine.rod.sections[0];
  section.nodes = 14;
  section.modes.bend = 10;
  if (section.modes.shear > 0) section.modes.shear = section.modes.stretch = 6;
  if (section.modes.twist > 0) section.modes.twist = 3;
  fine.config.tolerance = 1e-8;
  fine.step = 5e-4;
  return known[extra] = fine.tips();
}

Fall with_all_strains(Fall fall) {
  fall.rod.sections[0].modes.shear = fall.rod.sections[0].modes.stretch = 2;
  fall.rod.sections[0].modes.twist = 1;
  return fall;
}

void fall_all_strains(benchmark::State& state) {
  const Fall fall = with_all_strains(falling_tentacle(state.range(0), state.range(1)));
  bench_fall(state, fall, converged(fall, 0));
}
BENCHMARK(fall_all_strains)
    ->ArgNames({"steps", "nodes"})
    ->Args({50, 5})
    ->Args({100, 5})
    ->Args({200, 6})
    ->Unit(benchmark::kMicrosecond);

Fall with_tendons(Fall fall, bool by_displacement) {
  for (const double angle : {0.0, 120.0, 240.0})
    fall.rod.tendons.push_back({.section = 0, .radius = 0.02, .angle = angle * std::numbers::pi / 180});
  if (by_displacement) {
    for (TendonRoute& tendon : fall.rod.tendons) tendon.compliance = 1e-3;
    fall.tendons.displacements = {0.01, -0.005, -0.005};
  } else {
    fall.tendons.tensions = {20, 5, 5};
  }
  return fall;
}

// The fall with three tendons, prescribed by tensions (0) or displacements (1); bends alone (0) or all
// strains (1).
void fall_tendons(benchmark::State& state) {
  Fall fall = with_tendons(falling_tentacle(state.range(2), 5), state.range(0) != 0);
  if (state.range(1) != 0) fall = with_all_strains(fall);
  bench_fall(state, fall, converged(fall, static_cast<int>(1 + 2 * state.range(0) + state.range(1))));
}
BENCHMARK(fall_tendons)
    ->ArgNames({"displacements", "strains", "steps"})
    ->ArgsProduct({{0, 1}, {0, 1}, {50, 200}})
    ->Unit(benchmark::kMicrosecond);

// The soft tentacle falls on a post, alone (1) and with three tendons (2), compared with the free tentacle
// (0). Bends alone (0) or all strains (1); `modes` is the number of modes of each bend. Contact places are
// `mm` apart and need not be nodes.
void fall_on_a_post(benchmark::State& state) {
  Fall fall = falling_tentacle(state.range(2), state.range(3));
  const int post = static_cast<int>(state.range(0)), strains = static_cast<int>(state.range(1));
  if (strains != 0) fall = with_all_strains(fall);
  if (post == 2) fall = with_tendons(fall, false);
  const auto touch = [post](Fall& touching, double spacing) {
    if (post == 0) return;
    touching.contact = {
        .law = {.stiffness = 1e5, .slip_speed = 0.01},
        .obstacles = {CapsuleConfig{.from = {-0.25, -0.2, 0.35}, .to = {-0.25, 0.2, 0.35}, .radius = 0.03}},
        .places = contact_places(touching.rod, spacing)};
  };
  touch(fall, 3e-3);
  const Tips& known = converged(fall, 10 + 2 * post + strains);
  fall.rod.sections[0].modes.bend = static_cast<int>(state.range(4));
  touch(fall, 1e-3 * static_cast<double>(state.range(5)));
  bench_fall(state, fall, known);
}
BENCHMARK(fall_on_a_post)
    ->ArgNames({"post", "strains", "steps", "nodes", "modes", "mm"})
    ->ArgsProduct({{2}, {0}, {25, 32, 40, 50}, {4, 5}, {3, 4}, {30}})
    ->ArgsProduct({{0, 2}, {0}, {100, 200, 10000}, {5}, {4}, {30}})
    ->ArgsProduct({{0, 1, 2}, {0}, {50, 100, 200}, {7}, {6}, {15}})
    ->ArgsProduct({{0, 2}, {1}, {50, 100, 200}, {7}, {6}, {15}})
    ->Unit(benchmark::kMicrosecond);

// A tendon curls a tentacle up until it lies on itself: with self-contact (1) and without (0).
void curl_up(benchmark::State& state) {
  Rod rod = soft_arm_with_tendon(1e6);
  RodDynamics dynamics(rod);
  const RodContact contact(dynamics.chain(),
                           {.law = {.stiffness = 1e5}, .places = contact_places(rod, 0.01)});
  if (state.range(0) != 0) dynamics.set_surroundings(&contact);
  double iterations = 0;
  std::size_t contacts = 0;
  for (auto _ : state) {
    RodState moving = dynamics.rest();
    for (int i = 1; i <= 300; ++i) {
      const RodStep step = dynamics.step(moving, {.tensions = {std::min(12.0, 0.05 * i)}}, {}, 2e-3);
      iterations += step.iterations;
      benchmark::DoNotOptimize(step);
    }
    if (state.range(0) != 0) contacts = contact.find(dynamics.point_motions(moving)).size();
  }
  state.counters["contacts"] = static_cast<double>(contacts);
  state.counters["iterations"] = benchmark::Counter(iterations / 300, benchmark::Counter::kAvgIterations);
  state.counters["times_real"] = benchmark::Counter(0.6, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(curl_up)->ArgName("itself")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// The heavy steel rod with all strains and no damping. Its tendon's tension drops from 15 to 10 N, at once or
// within `ramp` seconds.
Eigen::Vector3d released_tip(double step, int bend, double ramp, double tolerance) {
  constexpr double rho = 0.5;
  const RodLoads weight{.gravity = {9.81, 0, 0}};
  Rod rod = heavy_rod();
  rod.sections[0].modes = {.shear = 1, .stretch = 1, .bend = bend, .twist = 1};
  RodDynamics dynamics(rod, {.spectral_radius = rho, .tolerance = tolerance});
  RodState moving = dynamics.rest(RodStatics(rod).solve({.tensions = {15}}, weight));
  TendonInput tendons{.tensions = {10}};
  const long steps = std::lround(0.2 / step);
  for (long i = 0; i < steps; ++i) {
    const double time = (static_cast<double>(i) + 1 / (1 + rho)) * step;
    if (ramp > 0) tendons.tensions[0] = 12.5 + 2.5 * std::cos(std::numbers::pi * std::min(1.0, time / ramp));
    benchmark::DoNotOptimize(dynamics.step(moving, tendons, weight, step));
  }
  return dynamics.tip(moving).position;
}

// Returns the tip with this number of modes in steps of 3 us.
const Eigen::Vector3d& finely_released_tip(int bend, double ramp) {
  static std::map<std::pair<int, double>, Eigen::Vector3d> known;
  const auto [at, is_new] = known.try_emplace({bend, ramp});
  if (is_new) at->second = released_tip(3.125e-6, bend, ramp, 1e-9);
  return at->second;
}

// `time_mm` is the error of the steps, against the same modes in steps of 3 us; `modes_mm` is that of the
// modes, against 12 modes in these small steps. A sudden drop excites bending waves that no step of 0.1 ms
// resolves and nothing damps.
void heavy_rod_released(benchmark::State& state) {
  constexpr int bend = 6, finest = 12;
  const double step = 1e-6 * static_cast<double>(state.range(0)),
               ramp = 1e-3 * static_cast<double>(state.range(1));
  Eigen::Vector3d found;
  for (auto _ : state) found = released_tip(step, bend, ramp, 1e-3);
  const Eigen::Vector3d known = finely_released_tip(finest, ramp), alike = finely_released_tip(bend, ramp);
  count(state, 0.2, {found, found}, {known, known});
  state.counters["time_mm"] = 1e3 * (found - alike).norm();
  state.counters["modes_mm"] = 1e3 * (alike - known).norm();
}
BENCHMARK(heavy_rod_released)
    ->ArgNames({"us", "ramp_ms"})
    ->ArgsProduct({{2000, 1000, 400, 200, 100, 50}, {0, 50}})
    ->Unit(benchmark::kMicrosecond);

// The same rod with this number of bend modes, in steps of 0.1 ms: error against 14 modes in the same steps.
void heavy_rod_modes(benchmark::State& state) {
  constexpr double step = 1e-4, tolerance = 1e-7;
  const double ramp = 1e-3 * static_cast<double>(state.range(1));
  Eigen::Vector3d found;
  for (auto _ : state) found = released_tip(step, static_cast<int>(state.range(0)), ramp, tolerance);
  const Eigen::Vector3d known = released_tip(step, 14, ramp, tolerance);
  count(state, 0.2, {found, found}, {known, known});
}
BENCHMARK(heavy_rod_modes)
    ->ArgNames({"modes", "ramp_ms"})
    ->ArgsProduct({{4, 6, 8, 10, 12}, {0, 50}})
    ->Unit(benchmark::kMicrosecond);

// Computes mass matrix, all forces and accelerations of three sections with six constant strains each.
void accelerations_of_3_sections(benchmark::State& state) {
  RodSection section{
      .length = 0.2, .radius = {5e-3, 5e-3}, .youngs_modulus = 1e9, .shear_modulus = 4e8, .density = 1000};
  section.modes = {.shear = 1, .stretch = 1, .bend = 1, .twist = 1};
  section.nodes = 5;
  RodDynamics dynamics({.sections = {section, section, section}, .tendons = {}});
  Eigen::VectorXd q = Eigen::VectorXd::Constant(dynamics.chain().size(), 0.1), v = q;
  const RodLoads weight{.gravity = {1, 2, -9}};
  for (auto _ : state) {
    q[0] += 1e-9;
    benchmark::DoNotOptimize(dynamics.acceleration(q, v, {}, weight));
  }
}
BENCHMARK(accelerations_of_3_sections)->Unit(benchmark::kMicrosecond);

// An arm of 1 m of this number of sections with seven modes each.
Rod arm_of_sections(std::size_t sections) {
  RodSection section{.length = 1.0 / static_cast<double>(sections),
                     .radius = {1e-2, 1e-2},
                     .youngs_modulus = 1e8,
                     .shear_modulus = 4e7,
                     .density = 1000,
                     .damping_time = 0.01};
  section.modes = {.shear = 1, .stretch = 1, .bend = 2, .twist = 1};
  section.nodes = 4;
  Rod rod;
  rod.sections.assign(sections, section);
  return rod;
}

void count_sections(benchmark::State& state) {
  state.counters["us_a_section"] =
      benchmark::Counter(static_cast<double>(state.range(0)) * 1e-6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// One step of an arm with this number of sections. The arm soon rests, so a step has one iteration.
void step_of_sections(benchmark::State& state) {
  RodDynamics dynamics(arm_of_sections(static_cast<std::size_t>(state.range(0))), {.tolerance = 1e-3});
  const RodLoads weight{.gravity = {0, -9.81, 0}};
  RodState moving = dynamics.rest();
  double iterations = 0;
  for (auto _ : state) {
    const RodStep step = dynamics.step(moving, {}, weight, 0.01);
    iterations += step.iterations;
    benchmark::DoNotOptimize(step);
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  count_sections(state);
}
BENCHMARK(step_of_sections)->ArgsProduct({{1, 2, 5, 10, 20, 50, 100}})->Unit(benchmark::kMicrosecond);

// Mass matrix, all forces and accelerations of the same arm.
void accelerations_of_sections(benchmark::State& state) {
  RodDynamics dynamics(arm_of_sections(static_cast<std::size_t>(state.range(0))));
  Eigen::VectorXd q = 0.1 / static_cast<double>(state.range(0)) *
                      Eigen::VectorXd::Ones(dynamics.chain().size()),
                  v = q;
  const RodLoads weight{.gravity = {0, -9.81, 0}};
  for (auto _ : state) {
    q[0] += 1e-9;
    benchmark::DoNotOptimize(dynamics.acceleration(q, v, {}, weight));
  }
  count_sections(state);
}
BENCHMARK(accelerations_of_sections)
    ->ArgsProduct({{1, 2, 5, 10, 20, 50, 100}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flexura
