#include "flexura/rig/ideal_picture.h"

#include <algorithm>
#include <cstddef>
#include <memory>

#include "flexura/camera/sensor.h"
#include "flexura/model/backbone.h"
#include "flexura/render/renderer.h"
#include "flexura/render/scene_maker.h"

namespace flexura {
namespace {

struct IdealCamera {
  ArmModel arm;
  SceneMaker maker;
  Renderer renderer;
  LightImage light;
};

}  // namespace

std::function<Image<std::uint8_t>(const View&, const ArmState&)> ideal_pictures(const Setup& setup) {
  const ArmModel arm = setup.arm_model();
  auto ideal = std::make_shared<IdealCamera>(IdealCamera{
      arm, SceneMaker(arm.driven(), setup.arm.look, setup.stand, setup.obstacle), Renderer(), {}});
  return [ideal](const View& view, const ArmState& state) {
    ideal->renderer.render(ideal->maker.scene(ideal->arm.backbone(state)), view, PixelKind::gray,
                           ideal->light);
    Image<std::uint8_t> picture(view.width, view.height);
    for (std::size_t i = 0; i < picture.values().size(); ++i)
      picture.values()[i] =
          static_cast<std::uint8_t>(std::clamp(255 * ideal->light.light.values()[i] + 0.5F, 0.0F, 255.0F));
    return picture;
  };
}

}  // namespace flexura
