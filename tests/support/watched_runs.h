#pragma once

#include <Eigen/Core>

#include "flexura/control/distributed_arm.h"
#include "flexura/control/lyapunov_monitor.h"
#include "flexura/control/potential_law.h"

namespace flexura {

inline constexpr OdeTolerance fine = {.relative = 1e-9, .absolute = 1e-11};

/// What drives an arm by a law; it returns what the law's damping takes.
inline DistributedMotion::Force forces_of(const PotentialLaw& law) {
  return [&law](double, const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                Eigen::VectorXd& Q) {
    law.force(arm, x, v, Q);
    return law.dissipation(v);
  };
}

/// A run from rest, watched; it ends early where the arm comes near to the coordinates' end.
inline LyapunovVerdict watched_run(const DistributedArm& arm, const PotentialLaw& law,
                                   const DistributedMotion::Force& force, const Eigen::VectorXd& start,
                                   double until, Eigen::VectorXd* end = nullptr) {
  DistributedMotion motion(arm, force, fine);
  motion.start(start);
  LyapunovMonitor monitor;
  for (int i = 0; i <= 100; ++i) {
    if (i > 0 && !motion.advance(until * i / 100)) break;
    // With a shaped elasticity V_e is part of Pi.
    const bool is_shaped = law.gains().elasticity == ElasticityRule::shaped;
    monitor.add({motion.time(), motion.arm().kinetic_energy(), law.potential(motion.arm(), motion.x()),
                 motion.arm().gravity_energy(), is_shaped ? 0 : motion.arm().elastic_energy(),
                 motion.summed(), motion.damped()});
    if (motion.arm().q().cwiseAbs().maxCoeff() > 1.45) break;
  }
  if (end != nullptr) *end = motion.x();
  return monitor.verdict();
}

}  // namespace flexura
