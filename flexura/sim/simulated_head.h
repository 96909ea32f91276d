#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/motion_ports.h"
#include "flexura/port/outcome.h"
#include "flexura/sim/axis_motion.h"
#include "flexura/sim/simulated_link.h"

namespace flexura {

/// Three axes that are commanded together, and what connects them.
class ThreeAxes {
 public:
  /// What the motors say.
  struct Reading {
    double time;                ///< s
    Eigen::Vector3d positions;  ///< Of the motors, in steps of their resolution, within their limits.
    bool moving;                ///< Any of the three.
  };

  /// What they carry stands at `start`, where the motors count `counted`: a difference stays as an offset.
  /// Half of each axis's backlash lies to either side of its motor. Commands take effect `delay` s after they
  /// were given, and positions are known back to `horizon` s before now.
  ThreeAxes(SimulatedLink link, const std::array<AxisConfig, 3>& axes, const Eigen::Vector3d& counted,
            const Eigen::Vector3d& start, double delay, double horizon);

  /// Sends all three. Refused: what is not finite. Positions are drawn to what can be commanded.
  CommandOutcome command(const Eigen::Vector3d& target);
  /// All three brake as fast as they can.
  CommandOutcome halt();
  [[nodiscard]] Outcome<Reading> read() const;
  /// Where what they carry is at `time` s, back to the horizon.
  [[nodiscard]] Eigen::Vector3d positions(double time) const;
  /// What connects them, which can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  std::array<AxisConfig, 3> configs_;
  std::vector<AxisMotion> axes_;
  Eigen::Vector3d offset_;  // of what they carry, from what the motors count
};

/// A head whose motors obey limits, rates, accelerations, resolution, backlash and delay.
class SimulatedHead : public HeadPort {
 public:
  /// The head of `camera` as it truly is, which stands at its start and counts `counted` there. It can be
  /// asked about back to `horizon` s before now.
  SimulatedHead(const Camera& camera, const HeadState& counted, const ClockPort& clock, double horizon);

  CommandOutcome command(const HeadState& state) override;
  CommandOutcome halt() override { return axes_.halt(); }
  Outcome<HeadReading> read() override;

  /// Where the camera is turned and zoomed to: not for algorithms.
  [[nodiscard]] HeadState truth(double time) const;
  /// What connects it, which can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return axes_.link(); }

 private:
  std::array<double, 2> zoom_limits_;
  ThreeAxes axes_;
};

/// The same of a stage, whose axes are the mount's (right, down, forward), m.
class SimulatedStage : public StagePort {
 public:
  /// The stage of `camera`, likewise (SimulatedHead).
  SimulatedStage(const Camera& camera, const StageState& counted, const ClockPort& clock, double horizon);

  CommandOutcome command(const StageState& state) override { return axes_.command(state.offset); }
  CommandOutcome halt() override { return axes_.halt(); }
  Outcome<StageReading> read() override;

  /// The mount's true offset; not for algorithms.
  [[nodiscard]] StageState truth(double time) const { return {axes_.positions(time)}; }
  /// What connects it, which can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return axes_.link(); }

 private:
  ThreeAxes axes_;
};

}  // namespace flexura
