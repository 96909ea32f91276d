#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/kinematics/motion.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/drive.h"
#include "flexura/model/obstacle.h"
#include "flexura/safety/violation.h"

namespace flexura {

class Rig;
class TaskRunner;
struct MissedTarget;

/// Part of a schedule: a task with its start and motion.
struct Leg {
  std::string name;  ///< Name of the task, or its kind (task_name).
  std::string kind;  ///< Kind of the task: "move", ...
  double start = 0;  ///< Start of the task, s.
  MotionPtr motion;  ///< Motion of the arm, never null; its times count from `start`.
  bool is_steered =
      false;  ///< Whether cameras control the motion; a limiter then checks each command during the run.
  bool is_planned =
      true;  ///< Whether the motion is known before the run. A servo's motion is known only afterwards.

  /// Returns the end of the task, s.
  [[nodiscard]] double end() const { return start + motion->duration(); }
};

using TaskRunners = std::vector<std::unique_ptr<TaskRunner>>;
/// Returns the runners of an experiment's tasks, in the tasks' order. The experiment must outlive the
/// runners.
[[nodiscard]] TaskRunners task_runners(const Experiment& experiment);

/// Motions of completed tasks, by the tasks' numbers. The map has only tasks whose motion is determined
/// during the run or by a simulation (TaskMotionSource).
using DoneTasks = std::map<std::size_t, MotionPtr>;

/// Planned motion of an experiment: the arm's state at every time, computed before anything moves.
class Schedule {
 public:
  /// Schedule before the run. For tasks whose motion is unknown, the schedule contains the largest possible
  /// motion.
  explicit Schedule(const Experiment& experiment);
  /// `tasks`: runners of the experiment's tasks. For tasks whose motion is neither known nor in `done`, the
  /// schedule contains the largest possible motion.
  Schedule(const Experiment& experiment, const TaskRunners& tasks, const DoneTasks& done);

  /// Returns the legs. Without tasks, the schedule has a single leg, which is a hold with duration 0.
  [[nodiscard]] const std::vector<Leg>& legs() const { return legs_; }
  [[nodiscard]] double duration() const { return duration_; }  ///< In s.
  /// Returns the number of clock steps after time 0. The last step is at duration(); all others are at
  /// multiples of the clock's step.
  [[nodiscard]] std::size_t steps() const { return steps_; }
  [[nodiscard]] double time_of_step(std::size_t step) const;  ///< In s.
  /// Returns the index of the leg at `time` (s). A leg includes its start but not its end; the last leg also
  /// includes its end.
  [[nodiscard]] std::size_t leg_at(double time) const;
  /// Returns the arm's state at the start.
  [[nodiscard]] const ArmState& initial() const { return initial_; }
  /// Returns the arm's state at `time` in [0, duration()] s.
  [[nodiscard]] ArmState state_at(double time) const;
  /// Returns bounds on each section's rates in [start, end] s; std::nullopt if a leg has no known rates.
  [[nodiscard]] std::optional<std::vector<SectionRates>> rates(double start, double end) const;
  /// Returns the hazards for the arm and its motors, and unreachable targets. `progress` may be null; the
  /// caller can cancel the check through it.
  [[nodiscard]] SafetyReport check(Progress* progress = nullptr) const;

 private:
  void add_missed(const MissedTarget& missed);

  ArmModel model_;
  std::optional<Drive> drive_;
  ArmState initial_;
  std::vector<Obstacle> obstacles_;
  std::vector<Violation> missed_targets_;
  double step_ = 0;
  double duration_ = 0;
  std::size_t steps_ = 0;
  std::vector<Leg> legs_;
};

/// Task that ends a run, and the reason for the end.
struct EndedBy {
  std::size_t task = 0;  ///< Number of the task.
  std::string failure;
};
/// Simulates every simulated task whose start is known, and adds its motion to `done`. A task's start is
/// known if the rig has performed all earlier tasks that need it. Stops at a task that ends the run, and
/// returns this task. `progress_of` returns the progress of a task's simulation.
[[nodiscard]] std::optional<EndedBy> simulate_tasks(
    const Experiment& experiment, const TaskRunners& tasks, DoneTasks& done,
    const std::function<Progress&(std::size_t task)>& progress_of);

/// Returns the hazards of a schedule (Schedule::check), with the caveats that its tasks add.
[[nodiscard]] SafetyReport checked(const Schedule& schedule, const TaskRunners& tasks,
                                   const std::optional<EndedBy>& ended_by, Progress* progress = nullptr);

/// Returns the hazards of an experiment, after the simulation of all tasks whose start is known. If a
/// simulated task ends the run, the first note states the reason.
[[nodiscard]] SafetyReport check_experiment_safety(const Experiment& experiment, Progress& progress);

/// Plays the schedule on the rig without recording frames. Starts at time 0 and ends with the first step at
/// `until` (s) or later. Ends earlier at the schedule's end, or before an impossible state. Returns the time
/// of the last step played, s.
[[nodiscard]] double play_unfilmed(double until, const Schedule& schedule, Rig& rig);

}  // namespace flexura
