#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "flexura/base/progress.h"
#include "flexura/calibrate/loop_session.h"
#include "flexura/calibrate/rig_session.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/filming.h"
#include "flexura/experiment/record_steps.h"
#include "flexura/experiment/witness.h"
#include "flexura/kinematics/motion.h"

namespace flexura {

/// What a task of kind "calibrate" did.
struct CalibrationRun {
  std::string name;
  std::size_t task = 0;                ///< Its number.
  std::array<std::string, 2> cameras;  ///< Their names.
  RigModel believed;                   ///< Before.
  RigSessionResult result;             ///< Of the method "bundle".
  std::optional<LoopResult> loop;      ///< Of one of the paper's methods, instead.
  MotionPtr motion;                    ///< Of the arm, as commanded, from the task's start.
  /// What truly remains where the cameras stand, of which the session knows nothing: simulated rigs tell.
  std::optional<RigRemainder> truth;

  [[nodiscard]] bool is_done() const { return loop ? loop->is_done : result.is_done; }
  [[nodiscard]] const std::string& reason() const { return loop ? loop->reason : result.reason; }
};

/// Does task number `task`, a calibration, on the rig that plays; what it does, sees and decides goes to the
/// witness.
[[nodiscard]] CalibrationRun run_calibration(const Experiment& experiment, std::size_t task, Filming& filming,
                                             Witness& witness, Progress& progress,
                                             const RecordSteps& record_steps);

}  // namespace flexura
