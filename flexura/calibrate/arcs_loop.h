#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

/// Base class of calibrations with arcs of the arm (section 3.4 of the paper). The arm bends into arcs in XOY
/// and ZOY. The cameras take pictures and move until their pictures agree with those of the simulator. Then
/// the zooms are equalised. Derived classes measure pictures, choose the moves of a camera, and decide when
/// the camera needs no further move.
class ArcsLoop {
 public:
  explicit ArcsLoop(LookLoop& loop) : loop_(loop) {}
  virtual ~ArcsLoop() = default;
  ArcsLoop(const ArcsLoop&) = delete;
  ArcsLoop& operator=(const ArcsLoop&) = delete;
  /// Runs the calibration. `aims_at_centers`: argument of plan_arcs().
  [[nodiscard]] LookLoop::Error run(bool aims_at_centers);

 protected:
  using Error = LookLoop::Error;

  /// Takes a picture of the current arc with camera i and measures it.
  [[nodiscard]] virtual Error look(std::size_t i) = 0;
  /// Evaluates all pictures of a round.
  [[nodiscard]] virtual Error learn() { return std::nullopt; }
  /// Sets `next` to the next position of a camera, or leaves `next` empty if the camera needs no further
  /// move.
  [[nodiscard]] virtual Error decide(std::size_t i, std::optional<RigStance>& next) = 0;
  /// Moves both cameras to the poses of the plan.
  [[nodiscard]] virtual Error align() = 0;

  /// Takes and measures a picture of each given arc with each given camera.
  [[nodiscard]] Error look_at(const std::vector<std::size_t>& arcs, const std::vector<std::size_t>& cameras);
  /// Repeats look_at(), learn() and the moves until the cameras need no further move. `numbers`: numbers of
  /// the arcs and the cameras.
  [[nodiscard]] Error settle(const std::vector<std::size_t>& numbers);

  LookLoop& loop_;
  ArcPlan plan_;

 private:
  [[nodiscard]] Error equalize_zooms();
};

/// Returns the method with the thirteen steps exactly as printed in the paper. Each camera looks at one arc
/// and moves until the centerline satisfies the circle's equation. The paper does not specify the motions.
/// Here the head moves the circle's centre to its position in the ideal image. Then the stage moves the
/// camera around the centre by the angle computed from the ellipse's axes. If the fit becomes worse, the
/// stage moves to the other side. The task warns which tilts the test cannot detect.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_as_printed(LookLoop& loop);
/// Returns a well-posed version of the method: both cameras observe the markers and centerlines of both arcs.
/// Each camera is commanded from its estimated to its ideal pose, until the remaining error is below the
/// resolutions of commands and pictures. Then both cameras take a picture with a longer focal length, from
/// which the principal points are estimated, and the loop continues. The calibration reports an error if
/// pictures disagree by more than their standard deviations, or if a pose cannot be commanded.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_corrected(LookLoop& loop);

/// Returns the prior of a rig for the calibration with arcs, derived from the prior of the default
/// calibration. Lenses are exact except for the principal point, whose standard deviation is 1 px. Heads are
/// exact except for their resolution. The bend error of a section is one factor, equal in all arcs.
[[nodiscard]] RigPrior arcs_prior(RigPrior prior);

}  // namespace flexura
