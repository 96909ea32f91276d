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

/// The arm at one time of a task of dynamics.
struct DynamicsSample {
  Eigen::VectorXd x;        ///< Coordinates of the distributed arm.
  LyapunovSample energies;  ///< With the time since the task's start.
};

/// How far an arm is from a task's target.
struct DynamicsError {
  double azimuth = 0, elevation = 0;  ///< Root mean square along the arm, rad.
  double spatial = 0;                 ///< Both together (docs/control.md, eq. 15), likewise.
  double tip = 0;                     ///< m
};

/// What a task of kind "dynamics" did.
struct DynamicsRun {
  std::string name;     ///< The task's.
  double start = 0;     ///< s
  DynamicsPlant plant;  ///< The arm as a continuum.
  PotentialLaw law;
  bool is_measured = false;                ///< The law had measured angles, not the arm's own.
  std::vector<DynamicsSample> samples;     ///< At the steps of the clock, and at both ends.
  std::vector<std::string> violations;     ///< Of the theory's conditions, known before anything moves.
  std::string stopped;                     ///< Why it ended early; empty: it did not.
  std::optional<LyapunovVerdict> verdict;  ///< None of a run that could not begin.
  std::vector<std::string> reasons;  ///< Why the run is not as the theory has it; empty: it is, or it was
                                     ///< measured and came to its target.
  DynamicsError remaining;           ///< At the end.
  /// PotentialRun::left_over
  double left_over = 0;
  double triangulated = 0;  ///< PotentialRun::triangulated
  double apart = 0;  ///< The largest distance of the arm's tip from that of the arcs it is shown by, m.
  MotionPtr motion;  ///< By those arcs, from the task's start.

  /// As the theory has it, or measured and come to its target.
  [[nodiscard]] bool is_done() const { return reasons.empty(); }
  [[nodiscard]] std::string reason() const;  ///< All of them; "" when done.
  /// How far the arm in a sample's coordinates is from the law's target.
  [[nodiscard]] DynamicsError error(const DynamicsSample& sample) const;
  /// The sample as the log has it: its time is since the experiment's start, s.
  [[nodiscard]] DynamicsSampleMessage message(const DynamicsSample& sample) const;
};

/// The law of a task for this arm.
[[nodiscard]] PotentialLaw potential_law_of(const DynamicsTask& task, const DynamicsPlant& plant);
/// Which conditions of the theory do not hold.
[[nodiscard]] std::vector<std::string> theory_violations(const DynamicsTask& task, const DynamicsPlant& plant,
                                                         const PotentialLaw& law);

/// Follows the task, the file's `number`th, that starts in `from` at `start` s.
[[nodiscard]] DynamicsRun run_dynamics(const DynamicsTask& task, const TaskLabel& label, const Setup& setup,
                                       const ArmState& from, double start, Progress& progress);

}  // namespace flexura
