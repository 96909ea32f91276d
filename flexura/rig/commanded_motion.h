#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/rig_ports.h"
#include "flexura/rig/record_steps.h"

namespace flexura {

/// The arm as a task commanded it since a time: from shape to shape in straight lines.
class CommandedMotion {
 public:
  CommandedMotion(double start, ArmState state);

  /// To `state`, from wherever the commands before have brought it at `time` s, in `duration` s.
  void send(double time, const ArmState& state, double duration);
  [[nodiscard]] ArmState at(double time) const;
  /// All of it up to `time`.
  [[nodiscard]] MotionPtr motion(double time) const;

 private:
  double start_;
  std::vector<double> times_ = {0};  // since the start
  std::vector<ArmState> states_;
};

/// A rig's ports for a task that commands the arm: the run's steps are recorded as the clock's time passes.
class RecordedPorts : private ClockPort {
 public:
  /// `from`: where the arm was sent last. The devices and `record` outlive it.
  RecordedPorts(const RigPorts& ports, ArmState from, const RecordSteps& record);

  [[nodiscard]] const RigPorts& ports() const { return ports_; }
  [[nodiscard]] CommandedMotion& motion() { return motion_; }
  /// Records what is left up to now, the task's end, and returns when that is, s.
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
