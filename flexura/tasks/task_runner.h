#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/kinematics/motion.h"
#include "flexura/log/run_log.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"
#include "flexura/report/report.h"
#include "flexura/rig/record_steps.h"
#include "flexura/rig/rig.h"
#include "flexura/rig/setup.h"
#include "flexura/safety/violation.h"
#include "flexura/tasks/task_label.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// A target of a task that the arm does not reach.
struct MissedTarget {
  std::string place;    ///< Place of the target in the task: "target[1]"; "" if there is only one.
  double distance = 0;  ///< Remaining distance, m.
  double limit = 0;     ///< Largest accepted distance, m.
  std::optional<Eigen::Vector3d> position = {};  ///< World, m; for a position of the tip.
};

/// Planned motion of a task.
struct TaskPlan {
  MotionPtr motion;         ///< Never null; its times count from the task's start.
  bool is_steered = false;  ///< By cameras: a limiter decides the commands during the run.
  bool is_planned = true;   ///< The motion is known before the run; a servo's only afterwards.
  std::vector<MissedTarget> missed = {};
};

/// Model of a rig in the course of a run.
struct NominalRig {
  RigModel model;         ///< From the file, or from calibrations.
  bool is_found = false;  ///< Calibrated by the default method, with mounts and lenses.
};

/// Resources of a task that the rig performs.
struct TaskStage {
  Rig& rig;
  NominalRig& nominal;
  RunLog& log;
  Progress& progress;
  const RecordSteps& record_steps;
  /// Returns the motor positions after the arm's motion through these states; std::nullopt without a command
  /// list.
  std::function<std::optional<std::vector<std::int64_t>>(std::span<const ArmState> way)> motors_after;
};

/// Result of a task.
struct TaskEnd {
  MotionPtr motion;                    ///< Commanded motion of the arm, from the task's start. Never null.
  std::optional<std::string> failure;  ///< Why the run ends with this task; std::nullopt: it continues.
};

/// Estimated work of a task, for progress: only ratios count.
struct TaskWork {
  double duration = 0;    ///< Time that is played, s; the rig's part of the work depends on it.
  double simulating = 0;  ///< Computing time of TaskRunner::simulate, s.
  double performing = 0;  ///< Computing time of TaskRunner::perform, s.
  double finishing = 0;   ///< Computing time of TaskRunner::finish, s.
};

/// Time at which a task's motion is known.
enum class TaskMotionSource : std::uint8_t {
  known,      ///< From the state at its start.
  simulated,  ///< After its simulation from the state at its start (TaskRunner::simulate).
  by_rig,     ///< After the rig has performed it (TaskRunner::perform).
};

/// One task of an experiment, from its plan to its results. A kind of task is a folder of tasks/ with one of
/// these; tasks/task_kinds.h lists them.
class TaskRunner {
 public:
  /// The setup must outlive this object.
  TaskRunner(const Setup& setup, TaskLabel label) : setup_(setup), label_(std::move(label)) {}
  virtual ~TaskRunner() = default;
  TaskRunner(const TaskRunner&) = delete;
  TaskRunner& operator=(const TaskRunner&) = delete;

  [[nodiscard]] const std::string& name() const { return label_.name; }
  [[nodiscard]] virtual TaskMotionSource motion_source() const { return TaskMotionSource::known; }
  /// Returns an estimate of its work.
  [[nodiscard]] virtual TaskWork work() const = 0;

  /// Returns the plan for an arm in the state `from`. `done`: the performed motion if known, otherwise null;
  /// the plan then has the largest possible motion.
  [[nodiscard]] virtual TaskPlan plan(const ArmState& from, const MotionPtr& done) const = 0;

  /// For simulated tasks: simulates it from `start` s on.
  [[nodiscard]] virtual TaskEnd simulate(const ArmState& /*from*/, double /*start*/, Progress& /*progress*/) {
    throw std::logic_error("this task is not simulated");
  }
  /// For tasks of the rig: performs it now. `from`: last commanded state of the arm.
  [[nodiscard]] virtual TaskEnd perform(const ArmState& /*from*/, TaskStage& /*stage*/) {
    throw std::logic_error("this task is not done by the rig");
  }

  /// Adds caveats and notes to the check of its motion. `ended_by`: the task that ends the run before this
  /// one is simulated, or "".
  virtual void add_caveats(const ArmState& /*from*/, const std::string& /*ended_by*/,
                           SafetyReport& /*report*/) const {}

  /// For simulated tasks: logs its results up to `time` s, when the run has played up to there.
  virtual void publish_up_to(double /*time*/, RunLog& /*log*/) {}

  /// Writes its files into the results. `is_cancelled`: the run was cancelled, and computations still open
  /// are skipped.
  virtual void finish(const std::filesystem::path& /*results*/, bool /*is_cancelled*/,
                      Progress& /*progress*/) {}

  /// Returns what came of it. A task that did not begin is not reached, with the text "not begun". `motion`:
  /// commanded motion, from its start; of tasks with a motion known from their start, which the caller knows
  /// to be played.
  [[nodiscard]] virtual TaskOutcome outcome(const Motion& motion) const = 0;
  /// Returns the summary's list of its kind: "servos"; "" if there is no list.
  [[nodiscard]] virtual std::string_view summary_list() const { return ""; }
  /// Returns its item in the list; std::nullopt without a result.
  [[nodiscard]] virtual std::optional<Node> summary() const { return std::nullopt; }
  /// Returns its chapter of the report; std::nullopt without a result. `number` counts tasks of its kind,
  /// from 0, for names of figures.
  [[nodiscard]] virtual std::optional<Chapter> chapter(std::size_t /*number*/) const { return std::nullopt; }

 protected:
  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] const TaskLabel& label() const { return label_; }

 private:
  const Setup& setup_;
  TaskLabel label_;
};

}  // namespace flexura
