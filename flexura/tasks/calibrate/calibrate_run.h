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

/// A simulated arc and its commands.
struct CommandedArc {
  IdealArc ideal;
  std::vector<double>
      rotations;  ///< Rotations of the bend directions about the axes of the sections' bases, rad.
  /// Motor positions, microsteps; missing for arms without drives.
  std::optional<std::vector<std::int64_t>> positions;
};

/// Result of a task of kind "calibrate".
struct CalibrationRun {
  std::string name;
  bool is_before_etalon =
      false;  ///< Whether the calibration used the calibration cylinder instead of the arm.
  std::array<std::string, 2> cameras;  ///< Names of the cameras.
  RigSigmas required = {};             ///< Required standard deviations, for the method "bundle".
  double accepted = 0;                 ///< Tolerance of offsets in pictures, px, for the paper's methods.
  RigModel nominal;                    ///< Model before the calibration.
  RigSessionResult result;             ///< Result of the method "bundle".
  std::optional<LoopResult> loop;  ///< Result if the method is one of the paper's; `result` is then empty.
  std::vector<CommandedArc> arcs;  ///< Arcs of the methods "arcs" and "arcs-paper", one per camera.
  MotionPtr motion;                ///< Commanded motion of the arm, from the task's start.
  /// True remaining errors at the cameras' final positions. Known only for simulated rigs; the calibration
  /// does not use these errors.
  std::optional<RigRemainder> truth;
  std::optional<std::array<double, 2>> true_focal =
      {};  ///< True focal lengths at the cameras' final positions, px; only for simulated rigs.

  /// Returns the model of the rig after the calibration: the nominal model updated with the results.
  [[nodiscard]] RigModel found() const;
  [[nodiscard]] bool is_done() const { return loop ? loop->is_done : result.is_done; }
  [[nodiscard]] const std::string& reason() const { return loop ? loop->reason : result.reason; }
};

/// Returns the image of the arm's axis that the ideal camera would observe, from base to tip, px. The result
/// is empty for methods without arcs.
[[nodiscard]] std::vector<Eigen::Vector2d> ideal_axis(const CalibrationRun& run,
                                                      const CameraObservation& observed);

/// Runs the task on the rig and logs its actions, observations and decisions. `from`: last commanded state of
/// the arm.
[[nodiscard]] CalibrationRun run_calibration(const CalibrateTask& task, const std::string& name,
                                             const Setup& setup, const ArmState& from, TaskStage& stage);

}  // namespace flexura
