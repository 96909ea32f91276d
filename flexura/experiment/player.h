#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/run_progress.h"
#include "flexura/experiment/run_recorder.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/run_watcher.h"
#include "flexura/rig/rig.h"
#include "flexura/safety/violation.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {

/// Progress of a run.
struct Played {
  std::size_t states = 0;  ///< Number of clock steps, from time 0.
  double time = 0;         ///< Time of the last clock step, s.
  ArmState last;
  bool is_cancelled = false;
  std::string failure;  ///< Reason if a task failed and ended the run, or "".
};

/// Plays an experiment's schedule step by step, and records the run with a RunRecorder.
class Player {
 public:
  /// `make_rig` is called if cameras are recorded, a task needs a rig, or the true arm differs from the
  /// model. If the schedule is unsafe, tasks that need a rig are skipped, and only a simulated rig moves.
  Player(const Experiment& experiment, RunRecorder& run_recorder, Progress& progress, RunWatcher* watcher,
         const RigFactory& make_rig);

  [[nodiscard]] const Schedule& schedule() const { return schedule_; }
  [[nodiscard]] const SafetyReport& safety() const { return safety_; }
  /// Returns the tasks with their results.
  [[nodiscard]] const TaskRunners& tasks() const { return tasks_; }

  /// Returns the progress of the run.
  [[nodiscard]] RunProgress& progress() { return progress_; }

  /// Plays all steps. Stops before the first impossible state, or when a task ends the run, or when the run
  /// is cancelled.
  Played play();

 private:
  struct Event {
    double time;
    Recorder::Level level;
    std::string name, text;
  };
  [[nodiscard]] Schedule scheduled();
  void report_progress(double time);
  [[nodiscard]] SafetyReport judged();
  void plan(double from);
  void publish_up_to(double time);
  void step(double time, const ArmState& state);
  [[nodiscard]] bool is_reading_due(double time);
  [[nodiscard]] bool is_rig_played() const;
  void play_to(double time, const ArmState& state);
  void notify_watcher(double time, const ArmState& state);
  void report_tasks(double time);
  [[nodiscard]] bool ends_with_simulated(double time);
  void stop_after(const Leg& leg, const std::string& failure);
  [[nodiscard]] std::optional<std::size_t> rig_task_due(double time) const;
  [[nodiscard]] bool perform(std::size_t task);

  const Experiment& experiment_;
  RunRecorder& run_recorder_;
  Progress& whole_;
  RunWatcher* watcher_;
  TaskRunners tasks_;
  RunProgress progress_;
  std::size_t finished_ = 0;             // Tasks whose progress is complete.
  std::vector<TaskRunner*> publishing_;  // Members of tasks_ that log during the run.
  DoneTasks done_;
  std::optional<EndedBy> ended_by_;  // The simulated task that ends the run.
  Schedule schedule_;
  SafetyReport safety_;
  std::unique_ptr<Rig> rig_;    // Null if no rig is used.
  std::vector<Camera> optics_;  // Camera models.
  std::vector<Event> events_;   // Pending events, in the order of time.
  NominalRig nominal_;
  std::size_t step_ = 0;  // Next step.
  Played played_;
  double last_reading_ = 0;  // Rig's time at which real devices were read for the log, s.
};

}  // namespace flexura
