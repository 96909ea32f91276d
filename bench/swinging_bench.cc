// Benchmarks of the servo of an arm that swings: whole turns with the simulated rig, and the solver of the
// predictive law beside a packaged one (NLopt's SLSQP).
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <exception>
#include <nlopt.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/control/predictive_law.h"
#include "flexura/servo/servo_session.h"
#include "tests/support/rig_bench.h"
#include "tests/support/servo_worlds.h"

namespace flexura {
namespace {

// Ends a servo after some steps.
class Counter : public ServoSessionWatcher {
 public:
  explicit Counter(int steps) : left_(steps) {}
  void arm_sent(double, const ArmState&, double) override {}
  void stepped(const ServoStep&) override { --left_; }
  bool is_cancelled() override { return left_ <= 0; }

 private:
  int left_;
};

// One turn of a servo at 30 Hz: dynamics between two frames, two pictures of 640 x 480 px, estimation, law
// and limiter. The first turns, until the arm is seen, count too.
void swinging_turn(benchmark::State& state, ServoLawKind law, double friction) {
  constexpr int turns = 60;
  const std::string text =
      swinging_world_file(study_rig({}), false, SwingingWorld{.stiffness = 1.2, .friction = friction});
  const ArmState command{{{0.7, 0.5}, {0.6, -0.4}, {-0.5, 0.6}}, {1, 1, 1}};
  for (auto _ : state) {
    state.PauseTiming();
    RigBench bench(text);
    const RigModel nominal = rig_model(bench.experiment().arm_model(), bench.experiment().cameras());
    ServoConfig config;
    config.law = law, config.tolerance = 1e-9, config.timeout = 100;
    config.goals = {{0, nominal.actuation.shape(command)}};
    Counter counter(turns);
    state.ResumeTiming();
    const ServoResult result = servo_in_session(bench.ports(), nominal, config, counter);
    if (result.reason != "cancelled") state.SkipWithError(result.reason.c_str());
  }
  state.SetItemsProcessed(turns * state.iterations());
}
BENCHMARK_CAPTURE(swinging_turn, predictive, ServoLawKind::predictive, 0.02)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(swinging_turn, predictive_without_friction, ServoLawKind::predictive, 0.0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(swinging_turn, computed_torque, ServoLawKind::computed_torque, 0.02)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(swinging_turn, shape, ServoLawKind::shape, 0.02)->Unit(benchmark::kMillisecond);

constexpr double law_step = 1.0 / 30, law_max_rate = std::numbers::pi / 2, law_max_bend = 2;

Arm law_arm() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(3);
  for (Section& section : arm.sections)
    section.length = 1.0 / 3, section.max_bend = law_max_bend, section.max_bend_rate = law_max_rate;
  return arm;
}

// A target so far away that rates are limited over much of the horizon.
PredictiveState law_state() {
  PredictiveState state{.sent = ArmState::straight(3),
                        .rate = {std::vector<Eigen::Vector2d>(3, Eigen::Vector2d::Zero()), {0, 0, 0}},
                        .rest = ArmState::straight(3),
                        .desired = {{{0.9, 0.4}, {-0.7, 0.8}, {0.6, -0.9}}, {1, 1, 1}}};
  for (int j = 0; j < 6; ++j) {
    SwingMode mode{.frequency = 6.0 + 7 * j, .damping = 0.01, .shape = {}, .kick = {}};
    mode.shape = Eigen::VectorXd::Zero(9), mode.kick = Eigen::VectorXd::Zero(9);
    for (int i = 0; i < 3; ++i) {
      mode.shape[3 * i + j % 2] = std::cos(1.3 * i * (j + 1));
      mode.kick[3 * i + j % 2] = -0.4 * std::cos(0.9 * i * (j + 1));
    }
    state.modes.push_back(mode);
  }
  state.swing = Eigen::VectorXd::Constant(12, 0.01);
  state.frequency_factors = Eigen::VectorXd::Ones(6);
  return state;
}

double cost_of(const PredictiveLaw::Problem& problem, const Eigen::VectorXd& x) {
  return 0.5 * x.dot(problem.H * x) + problem.gradient.dot(x);
}

// Largest excess of rates over their limit, rad/s.
double rate_excess(const Eigen::VectorXd& x) {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(6);
  double most = 0;
  for (Eigen::Index k = 0; k < x.size() / 6; ++k) {
    rate += x.segment<6>(6 * k);
    for (Eigen::Index i = 0; i < 6; i += 2) most = std::max(most, rate.segment<2>(i).norm() - law_max_rate);
  }
  return most;
}

void predictive_step(benchmark::State& state) {
  PredictiveLaw law(law_arm(), law_arm(), {.step = law_step});
  const PredictiveState now = law_state();
  const Eigen::MatrixXd by_command = Eigen::MatrixXd::Identity(9, 9);
  for (auto _ : state) benchmark::DoNotOptimize(law.step(now, by_command));
  state.counters["cost"] = cost_of(law.problem(), law.problem().found);
  state.counters["rate_excess"] = rate_excess(law.problem().found);
}
BENCHMARK(predictive_step)->Unit(benchmark::kMillisecond);

// The same program, built once, solved by NLopt from zero. Counters: its cost and how far it breaks the
// rates.
void nlopt_slsqp(benchmark::State& state) {
  PredictiveLaw law(law_arm(), law_arm(), {.step = law_step});
  (void)law.step(law_state(), Eigen::MatrixXd::Identity(9, 9));
  const PredictiveLaw::Problem problem = law.problem();
  const auto size = static_cast<unsigned>(problem.gradient.size());
  struct Limit {
    Eigen::Index step, at;
  };
  std::vector<Limit> limits;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(size) / 6; ++k)
    for (Eigen::Index i = 0; i < 6; i += 2) limits.push_back({k, i});
  const auto value = [](const std::vector<double>& x, std::vector<double>& slope, void* data) {
    const auto& of = *static_cast<const PredictiveLaw::Problem*>(data);
    const Eigen::Map<const Eigen::VectorXd> at(x.data(), static_cast<Eigen::Index>(x.size()));
    const Eigen::VectorXd product = of.H * at;
    if (!slope.empty())
      Eigen::Map<Eigen::VectorXd>(slope.data(), static_cast<Eigen::Index>(slope.size())) =
          product + of.gradient;
    return 0.5 * at.dot(product) + of.gradient.dot(at);
  };
  // Half of the squared rate's excess.
  const auto excess = [](const std::vector<double>& x, std::vector<double>& slope, void* data) {
    const Limit& limit = *static_cast<const Limit*>(data);
    Eigen::Vector2d rate = Eigen::Vector2d::Zero();
    for (Eigen::Index k = 0; k <= limit.step; ++k)
      for (Eigen::Index i = 0; i < 2; ++i) rate[i] += x[static_cast<std::size_t>(6 * k + limit.at + i)];
    if (!slope.empty()) {
      std::ranges::fill(slope, 0.0);
      for (Eigen::Index k = 0; k <= limit.step; ++k)
        for (Eigen::Index i = 0; i < 2; ++i) slope[static_cast<std::size_t>(6 * k + limit.at + i)] = rate[i];
    }
    return 0.5 * (rate.squaredNorm() - law_max_rate * law_max_rate);
  };
  std::vector<double> x(size);
  for (auto _ : state) {
    nlopt::opt solver(nlopt::LD_SLSQP, size);
    solver.set_min_objective(value, const_cast<PredictiveLaw::Problem*>(&problem));
    for (Limit& limit : limits) solver.add_inequality_constraint(excess, &limit, 1e-6);
    solver.set_ftol_rel(1e-10);
    solver.set_maxeval(3000);
    std::ranges::fill(x, 0.0);
    double cost = 0;
    try {
      (void)solver.optimize(x, cost);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  }
  const Eigen::Map<const Eigen::VectorXd> found(x.data(), static_cast<Eigen::Index>(x.size()));
  state.counters["cost"] = cost_of(problem, found);
  state.counters["rate_excess"] = rate_excess(found);
}
BENCHMARK(nlopt_slsqp)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
