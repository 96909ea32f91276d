#pragma once

#include <span>
#include <string>

#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/experiment/messages.h"
#include "flexura/model/arm.h"
#include "flexura/servo/servo_step.h"

namespace flexura {

/// Where a camera's head and stage say that they stand.
struct CameraReading {
  HeadState head;
  StageState stage;
};

/// Sees a run as it plays, on the run's thread. What it does with that changes nothing of the run.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  RunWatcher() = default;
  RunWatcher(const RunWatcher&) = delete;
  RunWatcher& operator=(const RunWatcher&) = delete;

  /// The arm's state at every step of the clock, s, and what is read from the cameras then, in their order:
  /// of none where the run plays no rig, whose cameras stand still.
  virtual void state(double time, const ArmState& state, std::span<const CameraReading> cameras) = 0;
  /// An event of the log: at `time` s, "info", "warning" or "error", of whom, and what.
  virtual void happened(double /*time*/, const std::string& /*level*/, const std::string& /*name*/,
                        const std::string& /*text*/) {}
  /// A command of a calibration, as the log has it.
  virtual void calibration_moved(const CalibrationMoveMessage& /*move*/) {}
  /// What a calibration sees in a picture, likewise.
  virtual void calibration_saw(const CalibrationSightingMessage& /*sighting*/) {}
  /// What a calibration decides, likewise; the last decision ends it.
  virtual void calibration_decided(const CalibrationDecisionMessage& /*decision*/) {}
  /// What a servo sends, as the log has it.
  virtual void servo_stepped(const ServoStep& /*step*/) {}
  /// What a servo sees in a picture, likewise.
  virtual void servo_saw(const ServoSightingMessage& /*sighting*/) {}
  /// A servo has ended.
  virtual void servo_ended() {}
};

}  // namespace flexura
