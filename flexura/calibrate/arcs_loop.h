#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

/// Calibrates with arcs of the arm (section 3.4): it is bent into arcs in XOY and ZOY, cameras look and move
/// until they see them as the simulator has it; then the zooms. What derives from it measures, and says where
/// a camera goes and when it stays.
class ArcsLoop {
 public:
  explicit ArcsLoop(LookLoop& loop) : loop_(loop) {}
  virtual ~ArcsLoop() = default;
  ArcsLoop(const ArcsLoop&) = delete;
  ArcsLoop& operator=(const ArcsLoop&) = delete;
  /// `aims_at_centers`: as plan_arcs has it.
  [[nodiscard]] LookLoop::Trouble run(bool aims_at_centers);

 protected:
  using Trouble = LookLoop::Trouble;

  /// Takes a picture of an arc and measures it.
  [[nodiscard]] virtual Trouble look(std::size_t i) = 0;
  /// What all pictures of a round tell.
  [[nodiscard]] virtual Trouble learn() { return std::nullopt; }
  /// Where a camera goes; nowhere where it stays.
  [[nodiscard]] virtual Trouble decide(std::size_t i, std::optional<RigStance>& next) = 0;
  /// Brings both cameras to where the plan has them.
  [[nodiscard]] virtual Trouble align() = 0;

  /// Looks at each of the arcs with each of the cameras.
  [[nodiscard]] Trouble look_at(const std::vector<std::size_t>& arcs,
                                const std::vector<std::size_t>& cameras);
  /// Looks at the arcs of these numbers with the cameras of these numbers, learns and moves until these stay.
  [[nodiscard]] Trouble settle(const std::vector<std::size_t>& numbers);

  LookLoop& loop_;
  ArcPlan plan_;

 private:
  [[nodiscard]] Trouble equalize_zooms();
};

/// The thirteen steps as printed: each camera looks at one arc and moves until the median axis verifies a
/// circle's equation. What the paper leaves open is how: the head brings the circle's centre to where the
/// simulator has it, then the stage takes the camera around the centre by what the ellipse's axes say, to the
/// one side or, when that made it worse, to the other. It warns with the power of the test.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_as_printed(LookLoop& loop);
/// Made well posed: both cameras see both arcs, by their markers and axes; what moves a camera from where all
/// these pictures put it to where the simulator has it is commanded, until nothing finer can be, or pictures
/// tell nothing finer. Then both look once with a longer focal length, which shows principal points, and go
/// on from what is known now. Pictures that do not agree within their standard deviations are trouble, and so
/// is what cannot be commanded.
[[nodiscard]] std::unique_ptr<ArcsLoop> arcs_corrected(LookLoop& loop);

/// How wrong a rig may be that is calibrated with arcs, by how wrong one may be beside: its lenses are known
/// but for 1 px of the principal point, its heads but for their steps, and a section's bends are wrong by the
/// same factor in every arc.
[[nodiscard]] RigPrior arcs_prior(RigPrior prior);

}  // namespace flexura
