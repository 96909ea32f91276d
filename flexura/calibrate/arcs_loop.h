#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

/// Base class of calibrations with arcs of the arm (section 3.4). The arm is bent into arcs in XOY and ZOY.
/// The cameras take pictures and move until the pictures show the arcs as the simulator does. Then the zooms
/// are equalized. Derived classes measure pictures, choose the moves of a camera and decide when it stays.
class ArcsLoop {
 public:
  explicit ArcsLoop(LookLoop& loop) : loop_(loop) {}
  virtual ~ArcsLoop() = default;
  ArcsLoop(const ArcsLoop&) = delete;
  ArcsLoop& operator=(const ArcsLoop&) = delete;
  /// Runs the calibration. `aims_at_centers`: see plan_arcs().
  [[nodiscard]] LookLoop::Error run(bool aims_at_centers);

 protected:
  using Error = LookLoop::Error;

  /// Takes a picture of the current arc with camera i and measures it.
  [[nodiscard]] virtual Error look(std::size_t i) = 0;
  /// Evaluates all pictures of a round.
  [[nodiscard]] virtual Error learn() { return std::nullopt; }
  /// Sets `next` to the next position of a camera; leaves it empty if the camera stays.
  [[nodiscard]] virtual Error decide(std::size_t i, std::optional<RigStance>& next) = 0;
  /// Moves both cameras to the poses of the plan.
  [[nodiscard]] virtual Error align() = 0;

  /// Takes and measures a picture of each of these arcs with each of these cameras.
  [[nodiscard]] Error look_at(const std::vector<std::size_t>& arcs, const std::vector<std::size_t>& cameras);
  /// Repeats look_at() for the arcs and cameras with these numbers, learn() and the moves, until the cameras
  /// stay.
  [[nodiscard]] Error settle(const std::vector<std::size_t>& numbers);

  LookLoop& loop_;
  ArcPlan plan_;

 private:
  [[nodiscard]] Error equalize_zooms();
};

/// The thirteen steps as the paper prints them. Each camera looks at one arc and moves until the centerline
/// satisfies the circle's equation. The paper does not specify the motions. Here the head brings the circle's
/// centre to its place in the ideal image. Then the stage moves the camera around the centre by the angle
/// computed from the ellipse's axes. If the fit becomes worse, the stage moves to the other side. The task
/// warns with the power of the test.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_as_printed(LookLoop& loop);
/// Well-posed version: both cameras see both arcs, with their markers and centerlines. Each camera is
/// commanded from its estimated to its ideal pose, until the remaining error is below the resolutions of
/// commands and pictures. Then both cameras take a picture with a longer focal length, which shows the
/// principal points, and the loop continues with that estimate. It is an error if pictures disagree by more
/// than their standard deviations, or if a pose cannot be commanded.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_corrected(LookLoop& loop);

/// Returns the prior of a rig for the calibration with arcs, derived from the prior of the default
/// calibration. Lenses are known except for 1 px of the principal point, and heads except for their steps.
/// The bend error of a section is one factor, equal in every arc.
[[nodiscard]] RigPrior arcs_prior(RigPrior prior);

}  // namespace flexura
