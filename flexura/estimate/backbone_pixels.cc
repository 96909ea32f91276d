#include "flexura/estimate/backbone_pixels.h"

#include "flexura/model/backbone.h"

namespace flexura {

std::vector<Eigen::Vector2d> backbone_pixels(const Arm& arm, const ArmState& state, const View& view,
                                             int count) {
  const Backbone backbone(arm, state);
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i <= count; ++i) {
    const auto pixel = view.project(backbone.pose(backbone.length() * i / count).position);
    if (pixel) pixels.push_back(*pixel);
  }
  return pixels;
}

}  // namespace flexura
