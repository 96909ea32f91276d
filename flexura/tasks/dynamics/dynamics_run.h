#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/control/lyapunov_monitor.h"
#include "flexura/control/potential_law.h"
#include "flexura/kinematics/motion.h"
#include "flexura/rig/setup.h"
#include "flexura/tasks/dynamics/dynamics_messages.h"
#include "flexura/tasks/dynamics/dynamics_plant.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

/// The arm at one time of a task of kind "dynamics".
struct DynamicsSample {
  Eigen::VectorXd x;        ///< Coordinates of the distributed arm.
  LyapunovSample energies;  ///< Includes the time since the task's start.
};

/// Distance of an arm from a task's target.
struct DynamicsError {
  double azimuth = 0, elevation = 0;  ///< Root mean square along the arm, rad.
  double spatial = 0;                 ///< Both together (docs/control.md, eq. 15), rad.
  double tip = 0;                     ///< In m.
};

/// Result of a task of kind "dynamics".
struct DynamicsRun {
  std::string name;     ///< Name of the task.
  double start = 0;     ///< In s.
  DynamicsPlant plant;  ///< The arm as a continuum.
  PotentialLaw law;
  bool is_measured = false;                ///< The law used measured angles, not the arm's true ones.
  std::vector<DynamicsSample> samples;     ///< At the clock steps, and at both ends.
  std::vector<std::string> violations;     ///< Violated conditions of the theory, known before the run.
  std::string stopped;                     ///< Why it ended early, or "".
  std::optional<LyapunovVerdict> verdict;  ///< Missing if the run could not begin.
  std::vector<std::string> reasons;  ///< Differences from theory; empty: none, or measured and at its target.
  DynamicsError remaining;           ///< At the end.
  /// PotentialRun::left_over
  double left_over = 0;
  double triangulated = 0;  ///< PotentialRun::triangulated
  double apart = 0;         ///< Largest distance of the arm's tip from that of its approximation by arcs, m.
  MotionPtr motion;         ///< Motion of the arcs, from the task's start.

  /// Returns true if the run is as in theory, or measured and at its target.
  [[nodiscard]] bool is_done() const { return reasons.empty(); }
  [[nodiscard]] std::string reason() const;  ///< Returns all reasons; "" if done.
  /// Returns the distance of the arm with a sample's coordinates from the law's target.
  [[nodiscard]] DynamicsError error(const DynamicsSample& sample) const;
  /// Returns the sample as logged: its time is since the experiment's start, s.
  [[nodiscard]] DynamicsSampleMessage message(const DynamicsSample& sample) const;
};

/// Returns the law of a task for this arm.
[[nodiscard]] PotentialLaw potential_law_of(const DynamicsTask& task, const DynamicsPlant& plant);
/// Returns the violated conditions of the theory.
[[nodiscard]] std::vector<std::string> theory_violations(const DynamicsTask& task, const DynamicsPlant& plant,
                                                         const PotentialLaw& law);

/// Runs the task labelled `label`, from the state `from` at `start` s.
[[nodiscard]] DynamicsRun run_dynamics(const DynamicsTask& task, const TaskLabel& label, const Setup& setup,
                                       const ArmState& from, double start, Progress& progress);

}  // namespace flexura
