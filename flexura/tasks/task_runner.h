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
  std::string place;    ///< Path of the target in the task: "target[1]"; "" if the task has only one target.
  double distance = 0;  ///< Remaining distance, m.
  double limit = 0;     ///< Largest accepted distance, m.
  std::optional<Eigen::Vector3d> position =
      {};  ///< Target position of the tip in W, m; missing for other targets.
};

/// Planned motion of a task.
struct TaskPlan {
  MotionPtr motion;  ///< Motion of the arm, never null; its times count from the task's start.
  bool is_steered =
      false;  ///< Whether cameras control the motion; a limiter then checks each command during the run.
  bool is_planned =
      true;  ///< Whether the motion is known before the run. A servo's motion is known only afterwards.
  std::vector<MissedTarget> missed = {};
};

/// Model of a rig during a run, which calibrations update.
struct NominalRig {
  RigModel model;         ///< Model from the file, or from a calibration.
  bool is_found = false;  ///< Whether a calibration by the default method has determined mounts and lenses.
};

/// Resources for a task that the rig performs.
struct TaskStage {
  Rig& rig;
  NominalRig& nominal;
  RunLog& log;
  Progress& progress;
  const RecordSteps& record_steps;
  /// Returns the motor positions after the arm has moved through these states; std::nullopt without a command
  /// list.
  std::function<std::optional<std::vector<std::int64_t>>(std::span<const ArmState> way)> motors_after;
};

/// Result of a task.
struct TaskEnd {
  MotionPtr motion;  ///< Commanded motion of the arm, with times from the task's start; never null.
  std::optional<std::string>
      failure;  ///< Why the run ends with this task; std::nullopt if the run continues.
};

/// Estimated work of a task, for the display of progress. Only the ratios between the parts of the work
/// matter.
struct TaskWork {
  double duration = 0;    ///< Duration of the task, s, to which the work of the rig is related.
  double simulating = 0;  ///< Computing time of TaskRunner::simulate, s.
  double performing = 0;  ///< Computing time of TaskRunner::perform, s.
  double finishing = 0;   ///< Computing time of TaskRunner::finish, s.
};

/// Time at which a task's motion is known.
enum class TaskMotionSource : std::uint8_t {
  known,  ///< The motion is known from the state at the task's start.
  /// The motion is known after a simulation that begins with the state at the task's start
  /// (TaskRunner::simulate).
  simulated,
  by_rig,  ///< The motion is known after the rig has performed the task (TaskRunner::perform).
};

/// One task of an experiment, from its plan to its results. Each kind of task has a folder in tasks/ with a
/// derived class; tasks/task_kinds.h lists the kinds.
class TaskRunner {
 public:
  /// The setup must outlive this object.
  TaskRunner(const Setup& setup, TaskLabel label) : setup_(setup), label_(std::move(label)) {}
  virtual ~TaskRunner() = default;
  TaskRunner(const TaskRunner&) = delete;
  TaskRunner& operator=(const TaskRunner&) = delete;

  [[nodiscard]] const std::string& name() const { return label_.name; }
  [[nodiscard]] virtual TaskMotionSource motion_source() const { return TaskMotionSource::known; }
  /// Returns an estimate of the task's work.
  [[nodiscard]] virtual TaskWork work() const = 0;

  /// Returns the plan for an arm in the state `from`. `done`: the performed motion, or null if it is not
  /// known. If `done` is null, the plan contains the largest possible motion.
  [[nodiscard]] virtual TaskPlan plan(const ArmState& from, const MotionPtr& done) const = 0;

  /// For tasks with TaskMotionSource::simulated: simulates the task, which begins at `start` (s).
  [[nodiscard]] virtual TaskEnd simulate(const ArmState& /*from*/, double /*start*/, Progress& /*progress*/) {
    throw std::logic_error("this task is not simulated");
  }
  /// For tasks with TaskMotionSource::by_rig: performs the task now. `from`: last commanded state of the arm.
  [[nodiscard]] virtual TaskEnd perform(const ArmState& /*from*/, TaskStage& /*stage*/) {
    throw std::logic_error("this task is not done by the rig");
  }

  /// Adds caveats and notes to the check of the task's motion. `ended_by`: the task that ends the run before
  /// this one is simulated, or "".
  virtual void add_caveats(const ArmState& /*from*/, const std::string& /*ended_by*/,
                           SafetyReport& /*report*/) const {}

  /// For tasks with TaskMotionSource::simulated: logs the task's results up to `time` (s). The run calls this
  /// function when it has reached `time`.
  virtual void publish_up_to(double /*time*/, RunLog& /*log*/) {}

  /// Writes the task's files into the results folder. If the run was cancelled (`is_cancelled`), skips the
  /// remaining computations.
  virtual void finish(const std::filesystem::path& /*results*/, bool /*is_cancelled*/,
                      Progress& /*progress*/) {}

  /// Returns the result of the task in words. For a task that did not begin, the result is not reached, with
  /// the text "not begun". `motion`: commanded motion, with times from the task's start. For tasks with
  /// TaskMotionSource::known, the caller ensures that the motion was played.
  [[nodiscard]] virtual TaskOutcome outcome(const Motion& motion) const = 0;
  /// Returns the name of the list for tasks of this kind in the summary, such as "servos"; "" if there is no
  /// list.
  [[nodiscard]] virtual std::string_view summary_list() const { return ""; }
  /// Returns the task's item in its kind's list in the summary; std::nullopt without a result.
  [[nodiscard]] virtual std::optional<Node> summary() const { return std::nullopt; }
  /// Returns the targets of the task for the report's 3D view, in the order of time. `motion`: commanded
  /// motion. Times count from the task's start.
  [[nodiscard]] virtual std::vector<ReportSpace::Target> targets(const Motion& /*motion*/) const {
    return {};
  }
  /// Returns the report's chapter on the task; std::nullopt without a result. `number`: index among the tasks
  /// of this kind, from 0, for names of figures.
  [[nodiscard]] virtual std::optional<Chapter> chapter(std::size_t /*number*/) const { return std::nullopt; }

 protected:
  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] const TaskLabel& label() const { return label_; }

 private:
  const Setup& setup_;
  TaskLabel label_;
};

}  // namespace flexura
