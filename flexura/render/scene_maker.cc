#include "flexura/render/scene_maker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "flexura/math/arrays.h"

namespace flexura {
namespace {

Screen screen_of(const ScreenConfig& config) {
  Screen screen;
  const Eigen::Vector3d z = vector(config.normal).normalized();
  // A screen that lies flat has its height along -Z.
  const bool is_upright = std::abs(z.y()) < 0.999;
  const Eigen::Vector3d up = is_upright ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, 0, -1);
  const Eigen::Vector3d x = up.cross(z).normalized();
  screen.X_WS.rotation << x, z.cross(x), z;
  screen.X_WS.position = vector(config.center);
  screen.size = {config.width, config.height};
  screen.brightness = Color::Constant(config.brightness);
  screen.gradient = config.gradient;
  screen.falloff = config.fall_off;
  return screen;
}

Etalon etalon_of(const EtalonConfig& config) {
  Etalon etalon;
  etalon.X_WE.rotation = rotation_of(config.rotation);
  etalon.X_WE.position = vector(config.position) + etalon.X_WE.rotation.col(1) * (config.height / 2);
  etalon.radius = config.radius;
  etalon.height = config.height;
  etalon.line_width = config.line_width;
  etalon.albedo = vector(config.color);
  etalon.line_albedo = vector(config.line_color);
  return etalon;
}

Light light_of(const LightConfig& config) {
  return {.direction = vector(config.towards),
          .ambient = config.ambient,
          .directional = config.directional,
          .shadow = config.shadow,
          .angular_radius = config.angular_radius};
}

}  // namespace

SceneMaker::SceneMaker(const Arm& arm, const LookConfig& look, const StandConfig& stand,
                       const std::vector<ObstacleConfig>& obstacles)
    : shows_arm_(stand.arm), markers_(look.markers(arm)), disks_(look.disk) {
  still_.arm.tip = look.tip;
  still_.arm.albedo = vector(look.color);
  still_.arm.disk_albedo = vector(look.disk_color);
  const Eigen::Vector3d& base = arm.X_WB.position;
  const auto screens = stand.screen.value_or(default_screens(arm.length(), {base.x(), base.y(), base.z()}));
  for (const ScreenConfig& screen : screens) still_.screens.push_back(screen_of(screen));
  if (stand.etalon) still_.etalon = etalon_of(*stand.etalon);
  for (const ObstacleConfig& obstacle : obstacles) {
    const auto color = std::visit([](const auto& kind) { return kind.color; }, obstacle);
    still_.obstacles.push_back({.shape = obstacle, .albedo = {color[0], color[1], color[2]}});
  }
  still_.light = light_of(stand.light);
  still_.background = Color::Constant(stand.background);
}

Scene SceneMaker::scene(const Backbone& backbone) const {
  Scene scene = still_;
  if (!shows_arm_) return scene;
  scene.arm.tube = tube_of(backbone);
  for (const Marker& marker : markers_) {
    const double from = std::max(marker.at - marker.width / 2, 0.0);
    scene.arm.markers.push_back({.s_from = backbone.s_at_rest(from),
                                 .s_to = backbone.s_at_rest(marker.at + marker.width / 2),
                                 .albedo = vector(marker.color)});
  }
  for (const Disk& disk : disks_) {
    scene.arm.disks.push_back(
        {.s = backbone.s_at_rest(disk.at), .radius = disk.radius, .thickness = disk.thickness});
  }
  return scene;
}

}  // namespace flexura
