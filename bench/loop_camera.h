#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <ctime>
#include <numbers>
#include <utility>
#include <vector>

#include "bench/render_scene.h"
#include "flexura/estimate/picture_observation.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

inline constexpr int loop_width = 640, loop_height = 480;

/// The scene of the renderer comparison, with or without rings, seen from 30 degrees to either side.
struct Sides {
  bool has_rings = true;
  double aside = std::numbers::pi / 6;
};

inline constexpr Sides with_rings = {}, without_rings = {.has_rings = false};

inline Setting setting_from(const Sides& sides, double angle) {
  Setting result = setting(loop_width, loop_height);
  if (!sides.has_rings) result.scene.arm.markers.clear();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector3d middle(0.19, 0.054, 0);
  result.view.X_WC.position = middle + turn * (result.view.X_WC.position - middle);
  result.view.X_WC.rotation = (turn * result.view.X_WC.rotation).eval();
  return result;
}

inline std::array<Setting, 2> both_settings(const Sides& sides) {
  return {setting_from(sides, -sides.aside), setting_from(sides, sides.aside)};
}

inline SensorConfig noisy() {
  return {.width = loop_width, .height = loop_height, .full_well = 10000, .read_noise = 1.5, .psf = 0.7};
}

/// One camera, with the sensor and the vision code for its pictures.
struct LoopCamera {
  View view = {};
  std::uint64_t number = 0;
  Sensor sensor = Sensor(noisy());
  Renderer renderer = Renderer();
  LightImage light = {};
  SensorRows rows = {};
  Image<std::uint8_t> picture = Image<std::uint8_t>(loop_width, loop_height);
  ArmFinder finder = ArmFinder();
  Observation seen = {};
  std::vector<Eigen::Vector2d> expected = {};    // Predicted centerline; empty: none.
  double drawing = 0, reading = 0, finding = 0;  // Totals over all cycles, s.
};

/// Measures the calling thread's CPU time, which other load on the machine does not affect.
class Stopwatch {
 public:
  double lap() {
    const double now = used();
    return now - std::exchange(last_, now);
  }

 private:
  static double used() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double last_ = used();
};

inline void look(LoopCamera& camera, const Scene& scene, std::uint64_t turn) {
  Stopwatch watch;
  camera.renderer.render(scene, camera.view, PixelKind::gray, camera.light);
  camera.drawing += watch.lap();
  camera.sensor.read(camera.light.light, {1, camera.number, turn}, camera.rows, camera.picture);
  camera.reading += watch.lap();
  camera.finder.expect(camera.expected);
  camera.seen = observation_of(camera.finder.find(camera.picture), camera.view);
  camera.finding += watch.lap();
}

}  // namespace flexura
