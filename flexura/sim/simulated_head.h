#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/motion_ports.h"
#include "flexura/sim/axis_motion.h"
#include "flexura/sim/simulated_link.h"

namespace flexura {

/// Three axes that are commanded together.
class ThreeAxes {
 public:
  /// Half of each axis's backlash lies to either side of its motor at the start.
  ThreeAxes(const std::array<AxisConfig, 3>& axes, const Eigen::Vector3d& start, double delay,
            double horizon);

  void command(double time, const Eigen::Vector3d& target);
  void halt(double time);
  /// Where the motors are, in steps of their resolution.
  [[nodiscard]] Eigen::Vector3d reading(double time) const;
  /// Where what they carry is.
  [[nodiscard]] Eigen::Vector3d positions(double time) const;
  [[nodiscard]] bool is_moving(double time) const;

 private:
  std::array<AxisConfig, 3> configs_;
  std::vector<AxisMotion> axes_;
};

/// A head whose motors obey limits, rates, accelerations, resolution, backlash and delay.
class SimulatedHead : public HeadPort {
 public:
  /// The head of `camera`, which it can be asked about back to `horizon` s before now.
  SimulatedHead(const Camera& camera, const ClockPort& clock, double horizon);

  CommandOutcome command(const HeadState& state) override;
  CommandOutcome halt() override;
  Outcome<HeadReading> read() override;

  /// Where the camera is turned and zoomed to: not for algorithms.
  [[nodiscard]] HeadState truth(double time) const;
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  std::array<double, 2> zoom_limits_;
  ThreeAxes axes_;
};

/// The same of a stage.
class SimulatedStage : public StagePort {
 public:
  SimulatedStage(const Camera& camera, const ClockPort& clock, double horizon);

  CommandOutcome command(const StageState& state) override;
  CommandOutcome halt() override;
  Outcome<StageReading> read() override;

  [[nodiscard]] StageState truth(double time) const { return {axes_.positions(time)}; }
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  ThreeAxes axes_;
};

}  // namespace flexura
