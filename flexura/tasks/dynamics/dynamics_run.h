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
  LyapunovSample energies;  ///< Energies, with the time since the task's start.
};

/// Distance of an arm from a task's target.
struct DynamicsError {
  double azimuth = 0, elevation = 0;  ///< Root mean square along the arm, rad.
  double spatial = 0;                 ///< Combined error of both angles (docs/control.md, eq. 15), rad.
  double tip = 0;                     ///< Distance of the tip from its target, m.
};

/// Result of a task of kind "dynamics".
struct DynamicsRun {
  std::string name;     ///< Name of the task.
  double start = 0;     ///< Time of the task's start, s.
  DynamicsPlant plant;  ///< The distributed arm.
  PotentialLaw law;
  bool is_measured = false;  ///< Whether the law used measured angles instead of the arm's true angles.
  std::vector<DynamicsSample> samples;  ///< Samples at the clock steps, and at the task's start and end.
  std::vector<std::string> violations;  ///< Violated conditions of the theory, known before the run.
  std::string stopped;                  ///< Why the task ended early, or "".
  std::optional<LyapunovVerdict>
      verdict;  ///< Agreement with the theory; missing if the task could not begin.
  /// Differences from the theory. Empty if the run agrees with the theory, or if the arm reached its target
  /// under a law that used measured angles.
  std::vector<std::string> reasons;
  DynamicsError remaining;  ///< Distance from the target at the end.
  /// Value of PotentialRun::left_over().
  double left_over = 0;
  double triangulated = 0;  ///< Value of PotentialRun::triangulated().
  double apart = 0;  ///< Largest distance of the arm's tip from the tip of its approximation by arcs, m.
  MotionPtr motion;  ///< Motion of the approximation by arcs, with times from the task's start.

  /// Returns true if the run agrees with the theory. With measured angles, returns true if the arm reached
  /// its target.
  [[nodiscard]] bool is_done() const { return reasons.empty(); }
  [[nodiscard]] std::string reason() const;  ///< Returns all reasons; "" if done.
  /// Returns the distance between the arm at a sample and the law's target.
  [[nodiscard]] DynamicsError error(const DynamicsSample& sample) const;
  /// Returns the sample as a message for the log, with the time since the experiment's start, s.
  [[nodiscard]] DynamicsSampleMessage message(const DynamicsSample& sample) const;
};

/// Returns the control law of a task of kind "dynamics" for this arm.
[[nodiscard]] PotentialLaw potential_law_of(const DynamicsTask& task, const DynamicsPlant& plant);
/// Returns the violated conditions of the theory.
[[nodiscard]] std::vector<std::string> theory_violations(const DynamicsTask& task, const DynamicsPlant& plant,
                                                         const PotentialLaw& law);

/// Runs the task with the label `label`. The task begins in the state `from` at the time `start` (s).
[[nodiscard]] DynamicsRun run_dynamics(const DynamicsTask& task, const TaskLabel& label, const Setup& setup,
                                       const ArmState& from, double start, Progress& progress);

}  // namespace flexura
