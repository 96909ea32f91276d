#pragma once

#include <cstddef>
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

/// One task, placed in time.
struct Leg {
  std::string name;         ///< The task's; its kind where it has none (task_name).
  std::string kind;         ///< "move", ...
  double start = 0;         ///< s
  MotionPtr motion;         ///< Never null; its times count from `start`.
  bool is_steered = false;  ///< By sight: a limiter decides on the way what is sent.
  bool is_foreseen = true;  ///< What it does is known; a servo's way is only once it has been done.

  [[nodiscard]] double end() const { return start + motion->duration(); }  ///< s
};

using TaskRunners = std::vector<std::unique_ptr<TaskRunner>>;
/// The runners of an experiment's tasks, in their order. The experiment outlives them.
[[nodiscard]] TaskRunners task_runners(const Experiment& experiment);

/// What tasks did whose motion is decided on the way or simulated before (TaskWay), by their numbers.
using DoneTasks = std::map<std::size_t, MotionPtr>;

/// What an experiment is going to do: the arm's state at every time, known before anything moves.
class Schedule {
 public:
  /// Before anything was done: tasks are taken to do everything that they may.
  explicit Schedule(const Experiment& experiment);
  /// `tasks` are its runners; those that are not among the `done` ones are taken to do everything that they
  /// may.
  Schedule(const Experiment& experiment, const TaskRunners& tasks, const DoneTasks& done);

  /// At least one: without tasks, a hold of no duration.
  [[nodiscard]] const std::vector<Leg>& legs() const { return legs_; }
  [[nodiscard]] double duration() const { return duration_; }  ///< s
  /// Steps of the clock after time 0; the last one is at duration(), the others at whole steps before it.
  [[nodiscard]] std::size_t steps() const { return steps_; }
  [[nodiscard]] double time_of_step(std::size_t step) const;  ///< s
  /// The leg under way at `time`; a leg owns its start, the last one its end too.
  [[nodiscard]] std::size_t leg_at(double time) const;
  /// The state in which the arm starts.
  [[nodiscard]] const ArmState& initial() const { return initial_; }
  /// The arm's state at `time` in [0, duration()] s.
  [[nodiscard]] ArmState state_at(double time) const;
  /// Bounds on how fast each section changes in [start, end] s; empty where a leg knows none.
  [[nodiscard]] std::optional<std::vector<SectionRates>> rates(double start, double end) const;
  /// What would harm the arm or be too much for its motors, and targets out of reach; known before anything
  /// moves. `progress` may be null, and may end the check early.
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

/// The task with which a run ends, and why.
struct EndedBy {
  std::size_t task = 0;  ///< Its number.
  std::string failure;
};
/// Simulates every task that is simulated and whose start is known: those before the first that the rig is
/// yet to do, or before one with which the run ends, which is answered. Adds what they did to `done`.
[[nodiscard]] std::optional<EndedBy> simulate_tasks(const Experiment& experiment, const TaskRunners& tasks,
                                                    DoneTasks& done, Progress& progress);

/// What the motions of this schedule of these tasks would harm (Schedule::check), with what each task adds.
[[nodiscard]] SafetyReport checked(const Schedule& schedule, const TaskRunners& tasks,
                                   const std::optional<EndedBy>& ended_by, Progress* progress = nullptr);

/// The same of an experiment as it stands, with the tasks simulated that can be. Why the run ends with one of
/// them is a note, the first one.
[[nodiscard]] SafetyReport check_experiment_safety(const Experiment& experiment, Progress& progress);

/// Plays the schedule on the rig from its start to its first step at `until` s or later, to its end, or to
/// the last step before a state that no arm can take, and films nothing. Returns the time of that step, s.
[[nodiscard]] double play_unfilmed(double until, const Schedule& schedule, Rig& rig);

}  // namespace flexura
