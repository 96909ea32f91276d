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

/// A task with its time.
struct Leg {
  std::string name;         ///< Name of the task, or its kind (task_name).
  std::string kind;         ///< "move", ...
  double start = 0;         ///< In s.
  MotionPtr motion;         ///< Never null; its times count from `start`.
  bool is_steered = false;  ///< By cameras: a limiter decides the commands during the run.
  bool is_planned = true;   ///< The motion is known before the run; a servo's only afterwards.

  [[nodiscard]] double end() const { return start + motion->duration(); }  ///< In s.
};

using TaskRunners = std::vector<std::unique_ptr<TaskRunner>>;
/// Returns the runners of an experiment's tasks, in their order. The experiment must outlive them.
[[nodiscard]] TaskRunners task_runners(const Experiment& experiment);

/// Motions of completed tasks that are decided during the run or simulated before (TaskMotionSource), by
/// their numbers.
using DoneTasks = std::map<std::size_t, MotionPtr>;

/// Planned motion of an experiment: the arm's state at every time, known before anything moves.
class Schedule {
 public:
  /// Schedule before the run: tasks have their largest possible motion.
  explicit Schedule(const Experiment& experiment);
  /// `tasks` are its runners; those that are not in `done` have their largest possible motion.
  Schedule(const Experiment& experiment, const TaskRunners& tasks, const DoneTasks& done);

  /// Returns the legs, at least one: without tasks, a hold of no duration.
  [[nodiscard]] const std::vector<Leg>& legs() const { return legs_; }
  [[nodiscard]] double duration() const { return duration_; }  ///< In s.
  /// Returns the number of clock steps after time 0; the last one is at duration(), the others at whole steps
  /// before it.
  [[nodiscard]] std::size_t steps() const { return steps_; }
  [[nodiscard]] double time_of_step(std::size_t step) const;  ///< In s.
  /// Returns the leg at `time`; a leg includes its start, the last one its end too.
  [[nodiscard]] std::size_t leg_at(double time) const;
  /// Returns the arm's state at the start.
  [[nodiscard]] const ArmState& initial() const { return initial_; }
  /// Returns the arm's state at `time` in [0, duration()] s.
  [[nodiscard]] ArmState state_at(double time) const;
  /// Returns bounds on each section's rates in [start, end] s; std::nullopt if a leg has no known rates.
  [[nodiscard]] std::optional<std::vector<SectionRates>> rates(double start, double end) const;
  /// Returns the hazards for the arm and its motors, and unreachable targets; known before anything moves.
  /// `progress` may be null, and may end the check early.
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

/// Task that ends a run, and the reason.
struct EndedBy {
  std::size_t task = 0;  ///< Its number.
  std::string failure;
};
/// Simulates every simulated task whose start is known: those before the first task that the rig still has to
/// do, or up to one that ends the run, which is returned. Adds their motions to `done`.
/// `progress_of` returns the progress of one.
[[nodiscard]] std::optional<EndedBy> simulate_tasks(
    const Experiment& experiment, const TaskRunners& tasks, DoneTasks& done,
    const std::function<Progress&(std::size_t task)>& progress_of);

/// Returns the hazards of this schedule of these tasks (Schedule::check), with the caveats that each task
/// adds.
[[nodiscard]] SafetyReport checked(const Schedule& schedule, const TaskRunners& tasks,
                                   const std::optional<EndedBy>& ended_by, Progress* progress = nullptr);

/// Returns the hazards of an experiment, after simulating the tasks for which this is possible. If the run
/// ends with one of them, the first note has the reason.
[[nodiscard]] SafetyReport check_experiment_safety(const Experiment& experiment, Progress& progress);

/// Plays the schedule on the rig without filming. Plays from its start to its first step at `until` s or
/// later, to its end, or to the last step before an impossible state. Returns the time of that step, s.
[[nodiscard]] double play_unfilmed(double until, const Schedule& schedule, Rig& rig);

}  // namespace flexura
