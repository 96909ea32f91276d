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

namespace flexura {

/// A target of a task that the arm does not come to.
struct MissedTarget {
  std::string place;    ///< Where the task says it: "target[1]"; "" where it has one only.
  double distance = 0;  ///< m, to where the arm comes.
  double limit = 0;     ///< m, that it may be.
  std::optional<Eigen::Vector3d> position = {};  ///< World, m; of a place for the tip.
};

/// What a task is going to do.
struct TaskPlan {
  MotionPtr motion;         ///< Never null; its times count from the task's start.
  bool is_steered = false;  ///< By sight: a limiter decides on the way what is sent.
  bool is_foreseen = true;  ///< What it does is known; a servo's way is only once it has been done.
  std::vector<MissedTarget> missed = {};
};

/// A rig as it is believed to be in the course of a run.
struct BelievedRig {
  RigModel model;         ///< By the file, or by calibrations.
  bool is_found = false;  ///< By one of the default method, with mounts and lenses.
};

/// What a task has to work with while the rig does it.
struct TaskStage {
  Rig& rig;
  BelievedRig& believed;
  RunLog& log;
  Progress& progress;
  const RecordSteps& record_steps;
  /// Where the motors come to be sent as the arm goes through these states; none without a command list.
  std::function<std::optional<std::vector<std::int64_t>>(std::span<const ArmState> way)> motors_after;
};

/// How a task ended.
struct TaskEnd {
  MotionPtr motion;                    ///< What the arm did, as commanded, from the task's start. Never null.
  std::optional<std::string> failure;  ///< Why the run ends with it; none: it goes on.
};

/// When a task's motion is known.
enum class TaskWay : std::uint8_t {
  known,      ///< From the state in which it starts.
  simulated,  ///< Once it has been simulated, from the state in which it starts (TaskRunner::simulate).
  by_rig,     ///< Once the rig has done it (TaskRunner::perform).
};

/// One task of an experiment, from its plan to what a run says of it. A kind of task is a folder of tasks/
/// with one of these; tasks/task_kinds.h lists them.
class TaskRunner {
 public:
  /// The setup outlives it.
  TaskRunner(const Setup& setup, TaskLabel label) : setup_(setup), label_(std::move(label)) {}
  virtual ~TaskRunner() = default;
  TaskRunner(const TaskRunner&) = delete;
  TaskRunner& operator=(const TaskRunner&) = delete;

  [[nodiscard]] const std::string& name() const { return label_.name; }
  [[nodiscard]] virtual TaskWay way() const { return TaskWay::known; }

  /// For an arm that stands in `from`. `done`: what the task did, where that is known; else null, and the
  /// plan is what it may do at most.
  [[nodiscard]] virtual TaskPlan plan(const ArmState& from, const MotionPtr& done) const = 0;

  /// Of tasks that are simulated: from `start` s on.
  [[nodiscard]] virtual TaskEnd simulate(const ArmState& /*from*/, double /*start*/, Progress& /*progress*/) {
    throw std::logic_error("this task is not simulated");
  }
  /// Of tasks that are done by the rig, now. `from`: where the arm was sent last.
  [[nodiscard]] virtual TaskEnd perform(const ArmState& /*from*/, TaskStage& /*stage*/) {
    throw std::logic_error("this task is not done by the rig");
  }

  /// Adds to the check of its motion what that does not tell. `ended_by`: the task with which the run ends
  /// before this one is simulated; "": none does.
  virtual void add_caveats(const ArmState& /*from*/, const std::string& /*ended_by*/,
                           SafetyReport& /*report*/) const {}

  /// Of tasks that are simulated: tells the log what came of it up to `time` s, when the run has played up to
  /// there.
  virtual void tell_up_to(double /*time*/, RunLog& /*log*/) {}

  /// Writes its files into the results. `is_cancelled`: the run was, and has no time for what is yet to be
  /// worked out.
  virtual void finish(const std::filesystem::path& /*results*/, bool /*is_cancelled*/) {}

  /// The summary's list in which its kind stands: "servos"; "": none.
  [[nodiscard]] virtual std::string_view summary_list() const { return ""; }
  /// Its entry there; none where nothing came of it.
  [[nodiscard]] virtual std::optional<Node> summary() const { return std::nullopt; }
  /// Its chapter of the report, likewise. `number` counts those of its kind, from 0, for names of figures.
  [[nodiscard]] virtual std::optional<Chapter> chapter(std::size_t /*number*/) const { return std::nullopt; }

 protected:
  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] const TaskLabel& label() const { return label_; }

 private:
  const Setup& setup_;
  TaskLabel label_;
};

}  // namespace flexura
