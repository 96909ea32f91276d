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

/// Three axes that are commanded together over one link.
class ThreeAxes {
 public:
  /// Measured positions of the motors.
  struct Reading {
    double time;                ///< Time of the measurement, s.
    Eigen::Vector3d positions;  ///< Motor positions, rounded to their resolution and within their limits.
    bool moving;                ///< Whether any of the three axes moves.
  };

  /// The axes start at the true positions `start`, where the motor counters have the values `counted`. The
  /// difference remains as an offset. Each axis's backlash is symmetric about its motor position. Commands
  /// take effect `delay` s after they were given. Positions can be queried back to `horizon` s before the
  /// present time.
  ThreeAxes(SimulatedLink link, const std::array<AxisConfig, 3>& axes, const Eigen::Vector3d& counted,
            const Eigen::Vector3d& start, double delay, double horizon);

  /// Commands all three axes. Clamps and quantises positions. Refuses values that are not finite.
  CommandOutcome command(const Eigen::Vector3d& target);
  /// Stops all three axes as fast as possible.
  CommandOutcome halt();
  [[nodiscard]] Outcome<Reading> read() const;
  /// Returns the load positions at `time`, s, at most the horizon before the present time.
  [[nodiscard]] Eigen::Vector3d positions(double time) const;
  /// Returns the link to the axes. The link can be interrupted temporarily.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  std::array<AxisConfig, 3> configs_;
  std::vector<AxisMotion> axes_;
  Eigen::Vector3d offset_;  // Load position minus motor count.
};

/// A head whose motors have limited ranges, rates and accelerations, a resolution, backlash and delay.
class SimulatedHead : public HeadPort {
 public:
  /// Creates the head of the true `camera` in its initial state, where its counters have the values
  /// `counted`. The head can be queried back to `horizon` s before the present time.
  SimulatedHead(const Camera& camera, const HeadState& counted, const ClockPort& clock, double horizon);

  CommandOutcome command(const HeadState& state) override;
  CommandOutcome halt() override { return axes_.halt(); }
  Outcome<HeadReading> read() override;

  /// Returns the true pan, tilt and zoom; not for algorithms.
  [[nodiscard]] HeadState truth(double time) const;
  /// Returns the link to the head. The link can be interrupted temporarily.
  [[nodiscard]] SimulatedLink& link() { return axes_.link(); }

 private:
  std::array<double, 2> zoom_limits_;
  ThreeAxes axes_;
};

/// A stage that moves along the mount's axes (right, down, forward), m. The motors of a stage are modelled as
/// the motors of a SimulatedHead.
class SimulatedStage : public StagePort {
 public:
  /// Creates the stage of the true `camera`. The arguments are as for SimulatedHead.
  SimulatedStage(const Camera& camera, const StageState& counted, const ClockPort& clock, double horizon);

  CommandOutcome command(const StageState& state) override { return axes_.command(state.offset); }
  CommandOutcome halt() override { return axes_.halt(); }
  Outcome<StageReading> read() override;

  /// Returns the true offset of the mount; not for algorithms.
  [[nodiscard]] StageState truth(double time) const { return {axes_.positions(time)}; }
  /// Returns the link to the stage. The link can be interrupted temporarily.
  [[nodiscard]] SimulatedLink& link() { return axes_.link(); }

 private:
  ThreeAxes axes_;
};

}  // namespace flexura
