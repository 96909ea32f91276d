#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

/// Base class of calibrations with arcs of the arm (section 3.4). The arm is bent into arcs in XOY and ZOY;
/// the cameras look and move until they see the arcs as in the simulator. Then the zooms follow. Derived
/// classes measure, choose the moves of a camera and decide when it stays.
class ArcsLoop {
 public:
  explicit ArcsLoop(LookLoop& loop) : loop_(loop) {}
  virtual ~ArcsLoop() = default;
  ArcsLoop(const ArcsLoop&) = delete;
  ArcsLoop& operator=(const ArcsLoop&) = delete;
  /// Runs the calibration; `aims_at_centers` as in plan_arcs.
  [[nodiscard]] LookLoop::Error run(bool aims_at_centers);

 protected:
  using Error = LookLoop::Error;

  /// Takes a picture of an arc and measures it.
  [[nodiscard]] virtual Error look(std::size_t i) = 0;
  /// Evaluates all pictures of a round.
  [[nodiscard]] virtual Error learn() { return std::nullopt; }
  /// Sets `next` to the next position of a camera; leaves it empty if the camera stays.
  [[nodiscard]] virtual Error decide(std::size_t i, std::optional<RigStance>& next) = 0;
  /// Moves both cameras to the poses of the plan.
  [[nodiscard]] virtual Error align() = 0;

  /// Looks at each of the arcs with each of the cameras.
  [[nodiscard]] Error look_at(const std::vector<std::size_t>& arcs, const std::vector<std::size_t>& cameras);
  /// Looks at the arcs with these numbers through the cameras with these numbers, learns and moves, until the
  /// cameras stay.
  [[nodiscard]] Error settle(const std::vector<std::size_t>& numbers);

  LookLoop& loop_;
  ArcPlan plan_;

 private:
  [[nodiscard]] Error equalize_zooms();
};

/// The thirteen steps as printed: each camera looks at one arc and moves until the centerline satisfies the
/// circle's equation. The paper leaves the motions open. Here the head brings the circle's centre to its
/// place in the simulator. Then the stage moves the camera around the centre by the angle from the ellipse's
/// axes. If that made it worse, the stage moves to the other side. The task warns with the power of the test.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_as_printed(LookLoop& loop);
/// Well-posed version: both cameras see both arcs, with their markers and centerlines. Each camera is
/// commanded from its estimated to the simulator's pose, until nothing finer can be commanded or seen. Then
/// both look once with a longer focal length, which shows the principal points, and continue with that
/// estimate. Pictures that disagree by more than their standard deviations are an error, and so are poses
/// that cannot be commanded.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_corrected(LookLoop& loop);

/// Returns the prior of a rig that is calibrated with arcs, from that of the default calibration. The lenses
/// are known except for 1 px of the principal point, the heads except for their steps. The bend error of a
/// section is one factor, equal in every arc.
[[nodiscard]] RigPrior arcs_prior(RigPrior prior);

}  // namespace flexura
