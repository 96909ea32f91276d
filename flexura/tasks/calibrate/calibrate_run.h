#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/calibrate/loop_session.h"
#include "flexura/calibrate/rig_session.h"
#include "flexura/kinematics/motion.h"
#include "flexura/port/rig_model.h"
#include "flexura/tasks/calibrate/calibrate_config.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {

/// An arc as the simulator has it, and how it is commanded.
struct CommandedArc {
  IdealArc ideal;
  std::vector<double> rotations;                       ///< Of its bends about their base's axis, rad.
  std::optional<std::vector<std::int64_t>> positions;  ///< Of the motors, microsteps; arms with drives.
};

/// What a task of kind "calibrate" did.
struct CalibrationRun {
  std::string name;
  bool is_before_etalon = false;       ///< It looked at the calibration cylinder, not at the arm.
  std::array<std::string, 2> cameras;  ///< Their names.
  RigModel believed;                   ///< Before.
  RigSessionResult result;             ///< Of the method "bundle".
  std::optional<LoopResult> loop;      ///< Of one of the paper's methods, instead.
  std::vector<CommandedArc> arcs;      ///< Of those with arcs: one a camera.
  MotionPtr motion;                    ///< Of the arm, as commanded, from the task's start.
  /// What truly remains where the cameras stand, of which the session knows nothing: simulated rigs tell.
  std::optional<RigRemainder> truth;

  /// The rig as it is known when all is done: as it was believed, with what was found.
  [[nodiscard]] RigModel found() const;
  [[nodiscard]] bool is_done() const { return loop ? loop->is_done : result.is_done; }
  [[nodiscard]] const std::string& reason() const { return loop ? loop->reason : result.reason; }
};

/// Where the ideal camera would see the axis in a picture, from base to tip, px; methods without arcs:
/// nowhere.
[[nodiscard]] std::vector<Eigen::Vector2d> ideal_axis(const CalibrationRun& run, const RigSight& sight);

/// Does the task on the rig that plays; what it does, sees and decides goes to the log. `from`: where the arm
/// was sent last.
[[nodiscard]] CalibrationRun run_calibration(const CalibrateTask& task, const std::string& name,
                                             const Setup& setup, const ArmState& from, TaskStage& stage);

}  // namespace flexura
