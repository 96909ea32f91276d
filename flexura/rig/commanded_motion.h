#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/rig_ports.h"
#include "flexura/rig/record_steps.h"

namespace flexura {

/// Commanded motion of the arm from a start time on. The motion is linear between the commanded shapes.
class CommandedMotion {
 public:
  CommandedMotion(double start, ArmState state);

  /// Adds a command that is sent at `time`, s, to reach `state` in `duration` s. The motion starts at the
  /// shape that is commanded at `time`.
  void send(double time, const ArmState& state, double duration);
  [[nodiscard]] ArmState at(double time) const;
  /// Returns the motion up to `time`.
  [[nodiscard]] MotionPtr motion(double time) const;

 private:
  double start_;
  std::vector<double> times_ = {0};  // Times since the start, s.
  std::vector<ArmState> states_;
};

/// Ports of a rig for a task that commands the arm. When the clock advances, this object records the steps of
/// the run.
class RecordedPorts : private ClockPort {
 public:
  /// `from`: last commanded state of the arm. The devices and `record` must outlive this object.
  RecordedPorts(const RigPorts& ports, ArmState from, const RecordSteps& record);

  [[nodiscard]] const RigPorts& ports() const { return ports_; }
  [[nodiscard]] CommandedMotion& motion() { return motion_; }
  /// Records the remaining steps up to the present time, at which the task ends. Returns this time, s.
  [[nodiscard]] double finish();

 private:
  [[nodiscard]] double now() const override { return clock_.now(); }
  void wait_until(double time) override;
  void record_up_to(double time);

  ClockPort& clock_;
  RigPorts ports_;
  CommandedMotion motion_;
  const RecordSteps& record_;
};

}  // namespace flexura
