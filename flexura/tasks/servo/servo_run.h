#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/servo_session.h"
#include "flexura/tasks/servo/servo_task_config.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {

/// What a task of kind "servo" did.
struct ServoRun {
  std::string name;
  std::array<std::string, 2> cameras;  ///< Their names.
  RigModel believed;
  double settle = 0;  ///< As the task has it, s.
  /// Its steps with the simulated truth, of which the session knows nothing. Where pictures are the target,
  /// truth is compared with the shape that they seemed to show.
  ServoResult result;
  std::optional<ServoError> true_remaining;  ///< Mean over the last `settle` s.
  MotionPtr motion;                          ///< Of the arm, as commanded, from the task's start.
};

/// Middles of the bands of an arm that turned out to be longer or shorter than its file says, m along it as
/// it is believed to be, rising: a band stays at its share of its section.
[[nodiscard]] std::vector<double> band_places(const Setup& setup, const Arm& believed);

/// What the task asks of a session, for an arm that is in the state `from`.
[[nodiscard]] ServoConfig servo_config(const Setup& setup, const ServoTask& task, const RigModel& believed,
                                       const ArmState& from);

/// Does the task on the rig that plays, as it is believed to be; what it does and sees goes to the log.
/// `from`: where the arm was sent last.
[[nodiscard]] ServoRun run_servo(const ServoTask& task, const std::string& name, const Setup& setup,
                                 const ArmState& from, TaskStage& stage);

}  // namespace flexura
