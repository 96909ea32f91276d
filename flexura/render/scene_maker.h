#pragma once

#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"
#include "flexura/model/look.h"
#include "flexura/model/obstacle.h"
#include "flexura/model/stand.h"
#include "flexura/render/scene.h"

namespace flexura {

/// Makes the scenes of an experiment from its fixed part and the arm's present shape.
class SceneMaker {
 public:
  /// Takes the arm with its `look`, and the fixed bodies. Uses the paper's screens if the stand has none. If
  /// `stand.arm` is false the scenes are without the arm.
  SceneMaker(const Arm& arm, const LookConfig& look, const StandConfig& stand,
             const std::vector<ObstacleConfig>& obstacles);

  /// Returns the scene with the arm along `backbone`. Markers and disks move with the arm's material: bands
  /// on a stretched section are stretched.
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
