#pragma once

#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"
#include "flexura/model/look.h"
#include "flexura/model/obstacle.h"
#include "flexura/model/stand.h"
#include "flexura/render/scene.h"

namespace flexura {

/// What cameras see of an experiment: the part that stays while the arm moves, and the arm as it stands.
class SceneMaker {
 public:
  /// An arm that is looked at with `look` before what stands there; the paper's screens where the stand names
  /// none. Where `stand.arm` is false the scenes are without the arm.
  SceneMaker(const Arm& arm, const LookConfig& look, const StandConfig& stand,
             const std::vector<ObstacleConfig>& obstacles);

  /// The scene with the arm along `backbone`. Markers and disks move with the arm's material: where a section
  /// is stretched, so are its bands.
  [[nodiscard]] Scene scene(const Backbone& backbone) const;

  /// The same without the arm.
  [[nodiscard]] const Scene& stand() const { return still_; }

 private:
  bool shows_arm_;
  std::vector<Marker> markers_;
  std::vector<Disk> disks_;
  Scene still_;
};

}  // namespace flexura
