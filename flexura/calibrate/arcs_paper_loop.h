#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/look_loop.h"
#include "flexura/vision/conic.h"

namespace flexura {

/// The paper's thirteen steps as printed (section 3.4): the first camera looks at an arc in XOY and moves
/// until the median axis verifies a circle's equation, the second one likewise at an arc in ZOY, then the
/// zooms. What the paper leaves open is how a camera is moved: the head brings the circle's centre to where
/// the simulator has it, then the stage takes the camera around the centre by what the ellipse's axes say, to
/// the one side or, when that made it worse, to the other. It warns with the power of the test.
class ArcsPaperLoop {
 public:
  explicit ArcsPaperLoop(LookLoop& loop);
  [[nodiscard]] LookLoop::Trouble run();

 private:
  using Trouble = LookLoop::Trouble;
  struct Orbit {
    double side = 1, share = 1, last_ratio = -1;
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] Trouble look(std::size_t i);
  [[nodiscard]] Trouble verify(std::size_t i);
  [[nodiscard]] Trouble centre(std::size_t i, const Eigen::Vector2d& off);
  [[nodiscard]] Trouble go_around(std::size_t i, Orbit& orbit);

  LookLoop& loop_;
  ArcPlan plan_;
  std::vector<ArmPicture> eyes_;
  std::vector<Eigen::Vector2d> points_;
  std::optional<CircleFit> circle_;
};

}  // namespace flexura
