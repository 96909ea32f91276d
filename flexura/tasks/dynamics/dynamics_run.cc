#include "flexura/tasks/dynamics/dynamics_run.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "flexura/control/potential_run.h"
#include "flexura/math/arrays.h"
#include "flexura/math/dense.h"
#include "flexura/math/hash.h"

namespace flexura {
namespace {

constexpr OdeTolerance tolerance = {.relative = 1e-9, .absolute = 1e-11, .most_steps = 50'000};

PotentialGains gains_of(const PotentialConfig& law) {
  PotentialGains gains{.stiffness = {law.stiffness[0], law.stiffness[1]},
                       .length_stiffness = law.length_stiffness,
                       .length_damping = law.length_damping,
                       .gravity_share = law.gravity_compensation,
                       .elasticity = law.elasticity,
                       .sign = static_cast<double>(law.sign)};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < 2; ++k)
      gains.damping(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = law.damping[i][k];
  return gains;
}

std::optional<AngleMeasurement> measurement_of(const Setup& setup, std::size_t number,
                                               const DynamicsTask& task) {
  if (!task.measurement) return std::nullopt;
  const double noise = task.measurement->noise;
  const bool is_planar = setup.arm.kind == ArmKind::planar;
  return AngleMeasurement{.step = task.measurement->step.value_or(setup.clock.step),
                          .delay = task.measurement->delay,
                          .noise = {noise, is_planar ? 0 : noise},
                          .seed = hash(static_cast<std::uint64_t>(setup.seed), number),
                          .reading = task.measurement->reading};
}

// Returns the clock steps within the task, and its end, s since its start.
std::vector<double> sample_times(double start, double duration, double step) {
  constexpr double rounding = 1e-9;
  std::vector<double> times;
  for (double k = std::floor(start / step) + 1; k * step < start + duration - rounding; ++k)
    if (k * step > start + rounding) times.push_back(k * step - start);
  times.push_back(duration);
  return times;
}

bool is_finite(const LyapunovSample& sample) {
  return std::isfinite(sample.kinetic + sample.potential + sample.gravity + sample.elastic + sample.taken +
                       sample.damped);
}

// Follows the run to its end.
void follow(DynamicsRun& run, PotentialRun& plant, const std::vector<double>& times, double share,
            Progress& progress) {
  // At the target only the integrator's error remains: 1e-6 rad along the arm.
  constexpr double least_turn = 1e-6;
  const PotentialGains& gains = run.law.gains();
  const std::vector<double>& lengths = plant.motion().arm().model().lengths;
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double rounding = gains.stiffness.cwiseAbs().maxCoeff() * length * least_turn * least_turn;
  LyapunovMonitor monitor(1e-6, share, rounding);
  const auto add = [&](const LyapunovSample& sample) {
    monitor.add(sample);
    run.samples.push_back({plant.motion().x(), sample});
  };
  add(plant.sample());
  // A step of a long arm is slow, and many may be needed from one sample to the next.
  const auto go_on = [&] {
    progress.update(plant.motion().time() / times.back(), run.name);
    return !progress.is_cancelled();
  };
  for (const double time : times) {
    if (!run.stopped.empty()) break;
    if (!plant.advance(time, go_on)) run.stopped = plant.stopped();
    const LyapunovSample sample = plant.sample();
    if (!is_finite(sample)) {
      run.stopped = "the energies are no longer finite";
    } else if (sample.time > run.samples.back().energies.time) {
      add(sample);
    }
  }
  run.left_over = plant.left_over(), run.triangulated = plant.triangulated();
  if (run.samples.size() > 1) run.verdict = monitor.verdict();
}

void judge(DynamicsRun& run) {
  run.reasons = run.violations;
  if (run.verdict && run.violations.empty()) {
    const LyapunovVerdict& verdict = *run.verdict;
    const bool falls = verdict.is_monotone && verdict.is_balanced;
    if (!run.is_measured && (run.stopped.empty() || !falls)) run.reasons = verdict.reasons;
    const auto value = [](const DynamicsSample& sample) {
      return sample.energies.kinetic + sample.energies.potential;
    };
    if (run.is_measured && run.stopped.empty() && !verdict.is_settled)
      run.reasons.push_back(fmt::format("W has not settled: {:.2g} J of {:.2g} J remain",
                                        value(run.samples.back()), value(run.samples.front())));
  }
  if (!run.stopped.empty()) run.reasons.push_back(run.stopped);
}

void show_as_arcs(DynamicsRun& run, const Arm& arm, const ArmState& from, Progress& progress) {
  std::vector<double> times;
  std::vector<ArmState> states;
  DistributedArm distributed = run.plant.distributed();
  for (const DynamicsSample& sample : run.samples) {
    if (progress.is_cancelled()) {
      run.stopped = "cancelled";
      break;
    }
    times.push_back(sample.energies.time);
    states.push_back(run.plant.state(sample.x, states.empty() ? from : states.back()));
    distributed.set(sample.x, Eigen::VectorXd::Zero(sample.x.size()));
    const Eigen::Vector3d tip = arm.X_WB.position + distributed.tip();
    run.apart = std::max(run.apart, (Backbone(arm, states.back()).tip().position - tip).norm());
  }
  run.motion = states.size() < 2 ? hold_motion(from, 0)
                                 : keyframe_motion(std::move(times), states, Interpolation::linear);
}

}  // namespace

PotentialLaw potential_law_of(const DynamicsTask& task, const DynamicsPlant& plant) {
  return {plant.distributed(), plant.target(), gains_of(task.law)};
}

std::vector<std::string> theory_violations(const DynamicsTask& task, const DynamicsPlant& plant,
                                           const PotentialLaw& law) {
  std::vector<std::string> found = law.violations();
  const Eigen::MatrixXd G = drives_of(plant.distributed(), task.law.drives);
  if (G.size() == 0) return found;
  const Eigen::Index rank = rank_of(G);
  if (rank < G.rows())
    found.push_back(fmt::format(
        "{} drives move an arm with {} coordinates: the drives cannot produce every force of the law", rank,
        G.rows()));
  return found;
}

std::string DynamicsRun::reason() const { return fmt::format("{}", fmt::join(reasons, "; ")); }

DynamicsError DynamicsRun::error(const DynamicsSample& sample) const {
  DistributedArm at = plant.distributed(), there = at;
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(sample.x.size());
  at.set(sample.x, still), there.set(law.target(), still);
  const Eigen::VectorXd& weights = at.shapes().weights;
  const auto rms = [&](const Eigen::VectorXd& difference) {
    return std::sqrt(weights.dot(difference.cwiseAbs2()) / weights.sum());
  };
  const Eigen::VectorXd e_theta = at.theta() - there.theta(), e_q = at.q() - there.q();
  const Eigen::VectorXd across = at.q().array().cos() * e_theta.array();
  return {rms(e_theta), rms(e_q), std::hypot(rms(e_q), rms(across)), (at.tip() - there.tip()).norm()};
}

DynamicsSampleMessage DynamicsRun::message(const DynamicsSample& sample) const {
  DistributedArm at = plant.distributed();
  at.set(sample.x, Eigen::VectorXd::Zero(sample.x.size()));
  const LyapunovSample& energies = sample.energies;
  const DynamicsError off = error(sample);
  DynamicsSampleMessage message{.time = start + energies.time,
                                .kinetic_energy = energies.kinetic,
                                .gravity_energy = at.gravity_energy(),
                                .elastic_energy = at.elastic_energy(),
                                .potential = energies.potential,
                                .lyapunov = energies.kinetic + energies.potential,
                                .taken_by_law = energies.taken,
                                .taken_by_medium = energies.damped,
                                .azimuth_error = off.azimuth,
                                .elevation_error = off.elevation,
                                .spatial_error = off.spatial,
                                .tip_error = off.tip,
                                .s = {},
                                .azimuths = {},
                                .elevations = {},
                                .points = {}};
  const Eigen::Matrix3Xd positions = at.positions();
  const auto add_point = [&](const Eigen::Vector3d& p_BP) {
    const Eigen::Vector3d p_WP = plant.base() + p_BP;
    message.points.push_back({p_WP.x(), p_WP.y(), p_WP.z()});
  };
  add_point(Eigen::Vector3d::Zero());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    message.s.push_back(at.shapes().s[i]);
    message.azimuths.push_back(at.theta()[i]), message.elevations.push_back(at.q()[i]);
    add_point(positions.col(i));
  }
  add_point(at.tip());
  return message;
}

DynamicsRun run_dynamics(const DynamicsTask& task, const TaskLabel& label, const Setup& setup,
                         const ArmState& from, double start, Progress& progress) {
  const Arm arm = setup.arm.arm();
  const DynamicsPlant plant(task, arm, from);
  const PotentialLaw law = potential_law_of(task, plant);
  DynamicsRun run{.name = label.name,
                  .start = start,
                  .plant = plant,
                  .law = law,
                  .is_measured = task.measurement.has_value(),
                  .samples = {},
                  .violations = theory_violations(task, plant, law),
                  .stopped = {},
                  .verdict = {},
                  .reasons = {},
                  .remaining = {},
                  .left_over = 0,
                  .triangulated = 0,
                  .motion = {}};
  if (plant.is_regular()) {
    PotentialRun motion(plant.distributed(), law, plant.start(), measurement_of(setup, label.number, task),
                        tolerance, drives_of(plant.distributed(), task.law.drives));
    follow(run, motion, sample_times(start, task.duration, setup.clock.step), task.tolerance, progress);
  } else {
    run.stopped = "the arm starts with an elevation of 90 deg, where the azimuth is undefined";
    run.samples.push_back({plant.start(), {}});
  }
  show_as_arcs(run, arm, from, progress);
  judge(run);
  run.remaining = run.error(run.samples.back());
  return run;
}

}  // namespace flexura
