#pragma once

#include <vector>

#include "flexura/experiment/record_steps.h"
#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/port/clock_port.h"

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

/// The rig's clock; the run's steps are recorded as its time passes.
class RecordedClock : public ClockPort {
 public:
  /// All outlive it.
  RecordedClock(ClockPort& clock, const RecordSteps& record, const CommandedMotion& motion)
      : clock_(clock), record_(record), motion_(motion) {}
  [[nodiscard]] double now() const override { return clock_.now(); }
  void wait_until(double time) override {
    clock_.wait_until(time);
    record_(now(), [this](double at) { return motion_.at(at); });
  }

 private:
  ClockPort& clock_;
  const RecordSteps& record_;
  const CommandedMotion& motion_;
};

}  // namespace flexura
