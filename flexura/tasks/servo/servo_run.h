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

/// Result of a task of kind "servo".
struct ServoRun {
  std::string name;
  std::array<std::string, 2> cameras;  ///< Names of the cameras.
  RigModel nominal;
  double settle = 0;  ///< The task's ServoSettings::settle, s.
  /// Result of the session. The steps in the result include the true errors in the simulation, which the
  /// session does not know. If the target is given by pictures, the true shape is compared with the shape
  /// estimated from these pictures.
  ServoResult result;
  std::optional<ServoError>
      true_remaining;  ///< Mean true error over the last `settle` s; missing if the truth is unknown.
  MotionPtr motion;    ///< Commanded motion of the arm, from the task's start.
};

/// Returns the increasing arc lengths of the middles of the arm's bands on the arm model `nominal`, m. If
/// calibrated section lengths differ from those of the file, each band keeps its relative position in its
/// section.
[[nodiscard]] std::vector<double> band_places(const Setup& setup, const Arm& nominal);

/// Returns the approximate duration of a servo task, s.
[[nodiscard]] double expected_duration(const ServoTask& task);

/// Returns the configuration of a session for the task, with the arm in the state `from`.
[[nodiscard]] ServoConfig servo_config(const Setup& setup, const ServoTask& task, const RigModel& nominal,
                                       const ArmState& from);

/// Runs the task on the rig with its model `nominal`, and logs its actions and observations. `from`: last
/// commanded state of the arm.
[[nodiscard]] ServoRun run_servo(const ServoTask& task, const std::string& name, const Setup& setup,
                                 const ArmState& from, TaskStage& stage);

}  // namespace flexura
