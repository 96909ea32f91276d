#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/calibrate/arc_fit.h"
#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

/// Calibrates with arcs of the arm (section 3.4), made well posed: both cameras see both arcs, by their
/// markers; what moves a camera from where these pictures put it to where the simulator has it is commanded,
/// until nothing finer can be, or pictures tell nothing finer. Then the zooms.
class ArcsLoop {
 public:
  explicit ArcsLoop(LookLoop& loop);
  [[nodiscard]] LookLoop::Trouble run();

 private:
  using Trouble = LookLoop::Trouble;
  [[nodiscard]] Trouble look(std::size_t i, std::size_t arc);
  [[nodiscard]] Trouble into_view(std::size_t i, std::size_t arc);
  [[nodiscard]] Trouble locate();
  [[nodiscard]] std::array<RigStance, 2> wanted() const;
  [[nodiscard]] double offset(std::size_t i) const;
  [[nodiscard]] View expected_view(std::size_t i) const;

  LookLoop& loop_;
  ArcPlan plan_;
  std::vector<ArmPicture> eyes_;
  std::array<Pose, 2> X_WM_;                     // Of the mounts at stage offset 0, as they are known.
  [[nodiscard]] Pose pose(std::size_t i) const;  // Of a camera where it stands, as it is known.

  std::vector<ArcPicture> pictures_;  // All of them.
  ArcFit fit_;
  bool is_located_ = false;
};

}  // namespace flexura
