#pragma once

#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"
#include "flexura/model/look.h"
#include "flexura/model/obstacle.h"
#include "flexura/model/stand.h"
#include "flexura/render/scene.h"

namespace flexura {

/// Makes the scenes of an experiment from the fixed bodies and the arm's current shape.
class SceneMaker {
 public:
  /// `look`: appearance of the arm. `stand` and `obstacles`: fixed bodies. If `stand` does not set screens,
  /// uses the paper's screens. If `stand.arm` is false, the scenes do not contain the arm.
  SceneMaker(const Arm& arm, const LookConfig& look, const StandConfig& stand,
             const std::vector<ObstacleConfig>& obstacles);

  /// Returns the scene with the arm along `backbone`. Markers and disks move with the arm's material, so
  /// bands on a stretched section are stretched.
  [[nodiscard]] Scene scene(const Backbone& backbone) const;

  /// Returns the scene without the arm.
  [[nodiscard]] const Scene& stand() const { return still_; }

 private:
  bool shows_arm_;
  std::vector<Marker> markers_;
  std::vector<Disk> disks_;
  Scene still_;
};

}  // namespace flexura
