// A calibration finds the arm with what separates it from its surroundings in each camera's pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "flexura/calibrate/arm_picture.h"
#include "flexura/vision/arm_scene.h"
#include "tests/support/drawn_scenes.h"

namespace flexura {
namespace {

TEST(ArmPictureScene, IsThatOfItsCamera) {
  DrawnScene scene(640, 480);
  scene.ground([](int, int, int) { return 210; }).arc(380, 240, 150, 18, 35);
  const Picture picture = scene.photograph(1, 2);
  ArmScene elsewhere;
  elsewhere.region = {{450, 20}, {620, 20}, {620, 460}, {450, 460}};
  ArmPictureConfig config;
  config.scenes = {nullptr, std::make_shared<const ArmScene>(elsewhere)};
  const auto is_found = [&](std::size_t camera) {
    const ArmFigure arm = ArmPicture(config, camera).look(picture);
    if (arm.axis.size() < 100) return false;
    for (const AxisSample& sample : arm.axis)
      if (sample.is_seen && std::abs(std::hypot(sample.pixel.x() - 380, sample.pixel.y() - 240) - 150) > 1)
        return false;
    return true;
  };
  EXPECT_TRUE(is_found(0));
  EXPECT_FALSE(is_found(1)) << "its region does not have the arm";
  EXPECT_TRUE(is_found(2)) << "beyond the list, there is no scene";
}

}  // namespace
}  // namespace flexura
