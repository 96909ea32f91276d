#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "flexura/model/backbone.h"
#include "flexura/port/camera_port.h"
#include "flexura/render/renderer.h"
#include "flexura/render/scene_maker.h"
#include "flexura/render/sensor_image.h"
#include "flexura/render/sensor_light.h"
#include "flexura/rig/setup.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {

/// Renders the pictures of an experiment's cameras from the true scene, the light and the sensor model. A
/// picture depends only on its shot.
class Photographer {
 public:
  explicit Photographer(const Setup& setup);

  [[nodiscard]] Picture take(const Shot& shot);

  /// Returns the true scene with the arm along `backbone`.
  [[nodiscard]] Scene scene(const Backbone& backbone) const { return maker_.scene(backbone); }

 private:
  [[nodiscard]] const Sensor& sensor(const Shot& shot);
  void gather(const Shot& shot);
  void draw(const Shot& shot, double time, const Rows& rows, Image<float>& light);
  [[nodiscard]] const Image<float>& backdrop(std::size_t camera);
  void draw_backdrop(const Image<float>& behind, const View& view, PixelKind pixels, int first_row);

  Setup setup_;
  SceneMaker maker_;
  Renderer renderer_;
  Scene scene_;
  LightImage instant_, on_white_;
  Image<float> light_, scratch_;
  SensorRows rows_;
  std::map<std::size_t, Sensor> sensors_;          // Sensor of each camera.
  std::map<std::size_t, Image<float>> backdrops_;  // Of each camera; empty: none.
};

}  // namespace flexura
