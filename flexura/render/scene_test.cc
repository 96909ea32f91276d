// Invalid scenes and cameras are refused by a message that names the part and the value.
#include "flexura/render/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/render/renderer.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct SceneView {
  Scene scene;
  View view;
};

// Returns the renderer's error message; "" if it draws the scene.
std::string refusal_of(const SceneView& scene_view) {
  Renderer renderer;
  LightImage picture;
  try {
    renderer.render(scene_view.scene, scene_view.view, PixelKind::gray, picture);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(Scene, RefusesWhatCannotBeDrawn) {
  TestRandom random(1);
  const BentArm bent = random_bent_arm(random, 0.003, 0.003);
  const SceneView good = {crowded_scene(random, bent.backbone()), random_view_of(random, bent.backbone())};
  ASSERT_EQ(refusal_of(good), "");

  struct Case {
    std::function<void(SceneView&)> change;
    std::string words;
  };
  const std::vector<Case> cases = {
      {[](SceneView& s) { s.view.X_WC.position.x() = nan; }, "camera: the pose"},
      {[](SceneView& s) { s.view.X_WC.position.x() = -3e154; }, "camera: (-3e+154"},
      {[](SceneView& s) { s.view.X_WC.rotation.col(0) *= -1; }, "camera: the pose"},
      {[](SceneView& s) { s.view.width = 0; }, "0 x"},
      {[](SceneView& s) { s.scene.arm.tube[0].radius[1] = 0; }, "the arm's arc 0, radius: 0"},
      {[](SceneView& s) { s.scene.arm.tube[1].X_WS.position.x() += 1e-3; },
       "the arm's arc 1 does not continue"},
      {[](SceneView& s) { s.scene.arm.tube[1].length = 2e9; }, "the arm's arc 1, length: 2000000000"},
      {[](SceneView& s) { s.scene.arm.tube[0].bend.x() = nan; }, "the arm's arc 0, bend: nan"},
      {[](SceneView& s) { s.scene.arm.albedo[0] = -1; }, "arm: (-1"},
      {[](SceneView& s) { s.scene.arm.markers.push_back({.s_from = 0.2, .s_to = 0.1}); }, "from 0.2 to 0.1"},
      {[](SceneView& s) { s.scene.arm.disks.push_back({.s = 0.1, .radius = 0.01, .thickness = 0}); },
       "disk, thickness"},
      {[](SceneView& s) { s.scene.screens.at(0).size = {1, -1}; }, "screen, size: -1"},
      {[](SceneView& s) { s.scene.etalon.emplace().radius = nan; }, "etalon, radius: nan"},
      {[](SceneView& s) {
         s.scene.obstacles.push_back({.shape = SphereConfig{.center = {0, 2e9, 0}, .radius = 1}});
       },
       "sphere, center: (0, 2000000000, 0)"},
      {[](SceneView& s) { s.scene.obstacles.push_back({.shape = PlaneConfig{.point = {}, .normal = {}}}); },
       "plane, normal's length: 0"},
      {[](SceneView& s) { s.scene.light.direction.setZero(); }, "light, direction's length: 0"},
      {[](SceneView& s) { s.scene.light.shadow = 2; }, "light: shadow 2"},
      {[](SceneView& s) { s.scene.background[2] = std::numeric_limits<double>::infinity(); }, "background"},
  };
  for (const Case& one : cases) {
    SceneView bad = good;
    one.change(bad);
    EXPECT_THAT(refusal_of(bad), HasSubstr(one.words));
  }
}

}  // namespace
}  // namespace flexura
