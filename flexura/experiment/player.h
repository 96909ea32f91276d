#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/calibrate_task.h"
#include "flexura/experiment/dynamics_run.h"
#include "flexura/experiment/filming.h"
#include "flexura/experiment/record_steps.h"
#include "flexura/experiment/run_watcher.h"
#include "flexura/experiment/schedule.h"
#include "flexura/experiment/servo_run.h"
#include "flexura/experiment/witness.h"
#include "flexura/port/rig_model.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// How far a run came.
struct Played {
  std::size_t states = 0;  ///< Of the clock's steps, from time 0.
  double time = 0;         ///< Of the last one, s.
  ArmState last;
  bool is_cancelled = false;
  std::string failure;  ///< Why a task stopped and the run with it; "": none did.
};

/// Plays an experiment's schedule, step by step, before the eyes of a witness.
class Player {
 public:
  /// Nothing that is unsafe is done by rigs: then calibrations and servos are only gone through.
  Player(const Experiment& experiment, Witness& witness, Progress& progress, RunWatcher* watcher);

  [[nodiscard]] const Schedule& schedule() const { return schedule_; }
  [[nodiscard]] const SafetyReport& safety() const { return safety_; }
  [[nodiscard]] const std::vector<CalibrationRun>& calibrations() const { return calibrations_; }
  [[nodiscard]] const std::vector<ServoRun>& servos() const { return servos_; }
  [[nodiscard]] const std::vector<DynamicsRun>& dynamics() const { return dynamics_; }

  /// Plays every step, or those before the first state that no arm can take, or until a calibration, a servo
  /// or a task of dynamics fails or it is cancelled.
  Played play();

 private:
  struct Event {
    double time;
    Recorder::Level level;
    std::string name, text;
  };
  [[nodiscard]] Schedule scheduled(double played);
  [[nodiscard]] SafetyReport judged();
  void plan(double from);
  void tell_up_to(double time);
  void step(double time, const ArmState& state);
  void film_to(double time, const ArmState& state);
  void read_rig();
  void tell_dynamics(double time);
  [[nodiscard]] bool ends_with_dynamics(double time);
  void stop_after(const Leg& leg, const std::string& failure);
  [[nodiscard]] std::optional<std::size_t> rig_task_due(double time) const;
  [[nodiscard]] bool perform(std::size_t task);
  struct Performed {
    MotionPtr motion;
    std::string failure;
  };
  [[nodiscard]] Performed calibrate(std::size_t task, const ArmState& from, const RecordSteps& record_steps);
  void learn(const CalibrationRun& run);
  [[nodiscard]] Performed servo(std::size_t task, const ArmState& from, const RecordSteps& record_steps);

  const Experiment& experiment_;
  Witness& witness_;
  Progress& progress_;
  RunWatcher* watcher_;
  // By task: what calibrations, servos and tasks of dynamics did.
  std::map<std::size_t, MotionPtr> performed_;
  std::vector<DynamicsRun> dynamics_;  // In the order of tasks; the last one may not be done.
  Schedule schedule_;
  SafetyReport safety_;
  std::optional<Filming> filming_;
  std::vector<Event> events_;  // Still to be told, in the order of time.
  std::vector<CalibrationRun> calibrations_;
  std::vector<ServoRun> servos_;
  RigModel believed_;                                 // By the file, or calibrations that found more.
  bool is_rig_found_ = false;                         // By one of the default method, with mounts and lenses.
  std::size_t dynamics_told_ = 0, samples_told_ = 0;  // Runs of dynamics in the log, samples of the next.
  std::size_t step_ = 0;                              // The next one.
  Played played_;
};

}  // namespace flexura
