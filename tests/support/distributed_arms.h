#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "flexura/control/distributed_arm.h"
#include "flexura/control/lyapunov_monitor.h"
#include "flexura/control/potential_run.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Returns a random model of one to three sections of any kind, with gravity in any direction, clamped or
/// free, with or without variable lengths.
inline DistributedArmModel random_distributed_arm(TestRandom& random) {
  DistributedArmModel model;
  model.lengths.clear();
  for (int i = random.integer(1, 3); i > 0; --i) model.lengths.push_back(random.uniform(0.2, 0.6));
  model.has_variable_lengths = random.integer(0, 1) == 1;
  model.density = random.uniform(0.3, 2);
  model.gravity = random.vector<3>(-1, 1).normalized() * random.uniform(1, 10);
  model.bending_stiffness = random.uniform(0.05, 1);
  model.axial_stiffness = random.uniform(20, 60);
  if (random.integer(0, 3) == 0)
    model.clamp.reset();
  else
    model.clamp = {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)};
  model.basis = random.integer(0, 3) == 0 ? AngleBasis::sections : AngleBasis::polynomial;
  model.nodes = random.integer(2, 6);
  model.points = 8;
  return model;
}

/// Returns random coordinates: smoothly varying angles up to `reach` rad, lengths within 10 %.
inline Eigen::VectorXd random_coordinates(TestRandom& random, const DistributedArm& arm, double reach = 1) {
  const Eigen::Vector4d a = random.vector<4>(-0.5, 0.5) * reach;
  double length = 0;
  for (const double l : arm.model().lengths) length += l;
  Eigen::VectorXd x = arm.coordinates([&](double s) -> Eigen::Vector2d {
    const double share = s / length;
    return {a[0] * share + a[1] * std::sin(3 * share), a[2] * share + a[3] * std::sin(2 * share)};
  });
  for (Eigen::Index i = 2 * arm.nodes(); i < arm.size(); ++i)
    x[i] = random.uniform(-0.1, 0.1) * arm.model().lengths[static_cast<std::size_t>(i - 2 * arm.nodes())];
  return x;
}

/// Returns random rates of either sign, up to `reach`.
inline Eigen::VectorXd random_rates(TestRandom& random, const DistributedArm& arm, double reach = 1) {
  Eigen::VectorXd v(arm.size());
  for (double& rate : v) rate = random.uniform(-reach, reach);
  return v;
}

/// Returns the Lyapunov verdict of a run that is sampled every `step` s until `until` s, or until it stops.
inline LyapunovVerdict watched(PotentialRun& run, double until, double step = 0.02) {
  LyapunovMonitor monitor;
  monitor.add(run.sample());
  for (int i = 1; i * step <= until * (1 + 1e-12) && run.stopped().empty(); ++i) {
    const double before = run.motion().time();
    (void)run.advance(i * step);
    if (run.motion().time() > before) monitor.add(run.sample());
  }
  return monitor.verdict();
}

}  // namespace flexura
