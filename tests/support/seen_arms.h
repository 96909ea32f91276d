#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"
#include "flexura/render/truth.h"
#include "tests/support/render_scenes.h"

namespace flexura {

/// Imaging conditions for random arms.
struct SeenArmConfig {
  double noise = 2;  ///< Standard deviation in values of an 8-bit image.
  double psf = 0.7;  ///< Standard deviation of the point spread function, px.
  double gamma = 1;  ///< Pixel values are light to the power 1/gamma.
  int width = 640, height = 480;
  bool color = false;
  bool bands = false;
  double most_bend = 1.2;  ///< Bend limit of a section, rad.
};

/// A picture of an arm and the true image of its backbone.
struct SeenArm {
  Scene scene;
  View view;
  Image<std::uint8_t> picture;
  std::vector<AxisPoint> truth;  ///< At equal spacing along the arm.
  double radius = 0;             ///< m
};

/// Returns a picture of a scene as delivered by a sensor.
inline Image<std::uint8_t> photograph(const Scene& scene, const View& view, const SeenArmConfig& options,
                                      std::uint64_t seed) {
  Renderer renderer;
  LightImage light;
  const PixelKind pixels = options.color ? PixelKind::color : PixelKind::gray;
  renderer.render(scene, view, pixels, light);
  SensorConfig config;
  config.width = view.width, config.height = view.height;
  config.pixels = pixels;
  config.psf = options.psf, config.read_noise = options.noise, config.gamma = options.gamma;
  SensorRows rows;
  Image<std::uint8_t> picture(view.width, view.height, config.channels());
  Sensor(config).read(light.light, {seed, 0, 0}, rows, picture);
  return picture;
}

/// Returns the exact image of the backbone at `count` places.
inline std::vector<AxisPoint> true_axis(const Scene& scene, const View& view, int count) {
  Renderer renderer;
  renderer.prepare(scene, view);
  std::vector<double> s;
  const double length = scene.arm.tube.back().s + scene.arm.tube.back().length;
  for (int i = 0; i < count; ++i) s.push_back(length * i / (count - 1));
  return projected_axis(renderer, s);
}

/// A randomly bent dark arm of one to four sections on a bright background.
struct RandomArm {
  BentArm bent;
  double radius = 0;  ///< m
  Scene scene;
};
inline RandomArm random_arm(TestRandom& random, const SeenArmConfig& options) {
  RandomArm arm;
  BentArm& bent = arm.bent;
  bent.arm.kind = ArmKind::spatial;
  arm.radius = random.uniform(0.012, 0.03);
  const int count = random.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    Section& section = bent.arm.sections.emplace_back();
    section.length = random.uniform(0.15, 0.35);
    section.radius = {arm.radius, arm.radius};
  }
  bent.state = ArmState::straight(bent.arm.sections.size());
  for (Eigen::Vector2d& bend : bent.state.bends)
    bend = random.uniform(0, options.most_bend) * random.vector<2>(-1, 1).normalized();
  const Backbone backbone = bent.backbone();
  arm.scene.background = Color::Constant(random.uniform(0.7, 0.9));
  arm.scene.arm.tube = tube_of(backbone);
  arm.scene.arm.tip = random.integer(0, 1) == 0 ? TipKind::flat : TipKind::round;
  arm.scene.arm.albedo = {0.08, 0.08, 0.09};
  for (double s = 0.05; options.bands && s < backbone.length() - 0.03; s += 0.07)
    arm.scene.arm.markers.push_back({s, s + 0.015, {0.85, 0.1, 0.1}});
  return arm;
}

/// Returns a random arm seen from 1.2 to 3 m away, from any side.
inline SeenArm random_seen_arm(TestRandom& random, const SeenArmConfig& options) {
  SeenArm seen;
  RandomArm arm = random_arm(random, options);
  const Backbone backbone = arm.bent.backbone();
  seen.radius = arm.radius, seen.scene = std::move(arm.scene);
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  const Eigen::Vector3d direction(random.uniform(-1, 1), random.uniform(-0.4, 0.4), random.uniform(-1, 1));
  const Eigen::Vector3d from = middle + direction.normalized() * random.uniform(1.2, 3);
  seen.view = pinhole_view(look_at(from, middle + random.vector<3>(-0.1, 0.1)), options.width, options.height,
                           random.uniform(1.1, 1.7) * options.width * (from - middle).norm() / 2.4);
  seen.picture =
      photograph(seen.scene, seen.view, options, static_cast<std::uint64_t>(random.integer(0, 1 << 30)));
  seen.truth = true_axis(seen.scene, seen.view, 601);
  return seen;
}

/// Returns the signed distance of a pixel to a curve given by close points, px. The sign gives the side.
inline double distance_to(const std::vector<AxisPoint>& curve, const Eigen::Vector2d& pixel) {
  double best = 1e9, sign = 1;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    if (!curve[i].pixel || !curve[i + 1].pixel) continue;
    const Eigen::Vector2d from = *curve[i].pixel, way = *curve[i + 1].pixel - from, to = pixel - from;
    const double share = std::clamp(to.dot(way) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
    const double distance = (to - share * way).norm();
    if (distance < best) best = distance, sign = way.x() * to.y() - way.y() * to.x() < 0 ? -1 : 1;
  }
  return sign * best;
}

}  // namespace flexura
