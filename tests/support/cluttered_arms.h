#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "flexura/vision/picture_file.h"
#include "tests/support/drawn_scenes.h"
#include "tests/support/seen_shapes.h"

namespace flexura {

/// Pictures of rooms, things and textures in Debian's packages opencv-doc and visp-images-data.
inline const std::vector<std::string>& clutter_files() {
  static const std::vector<std::string> files = [] {
    const std::string opencv = "/usr/share/doc/opencv-doc/examples/data/",
                      visp = "/usr/share/visp-images-data/ViSP-images/";
    std::vector<std::string> list;
    for (const char* name :
         {"aero1.jpg",    "aero3.jpg",        "aloeL.jpg",    "apple.jpg",     "baboon.jpg",
          "board.jpg",    "box_in_scene.png", "building.jpg", "butterfly.jpg", "fruits.jpg",
          "graf1.png",    "graf3.png",        "home.jpg",     "left01.jpg",    "left05.jpg",
          "leuvenA.jpg",  "messi5.jpg",       "orange.jpg",   "right09.jpg",   "rubberwhale1.png",
          "smarties.png", "starry_night.jpg", "stuff.jpg",    "sudoku.png"})
      list.push_back(opencv + name);
    for (const char* name : {"Klimt/Klimt.ppm", "Solvay/Solvay_conference_1927_Version2_640x440.jpg"})
      list.push_back(visp + name);
    std::erase_if(list, [](const std::string& file) { return !std::filesystem::exists(file); });
    return list;
  }();
  return files;
}

/// Returns a picture file as RGB light from 0 to 1, scaled and cut to a size.
inline Image<float> clutter_light(const std::string& file, int width, int height) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  const Image<std::uint8_t> from = decode_picture(bytes, file).bytes;
  const double scale = std::min(static_cast<double>(from.width() - 1) / width,
                                static_cast<double>(from.height() - 1) / height);
  Image<float> light(width, height, 3);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double x = u * scale, y = v * scale;
      const int a = static_cast<int>(x), b = static_cast<int>(y);
      const double s = x - a, t = y - b;
      for (int c = 0; c < 3; ++c) {
        const int k = from.channels() == 3 ? c : 0;
        const double above = (1 - s) * from.at(a, b, k) + s * from.at(a + 1, b, k),
                     below = (1 - s) * from.at(a, b + 1, k) + s * from.at(a + 1, b + 1, k);
        light.at(u, v, c) = static_cast<float>(((1 - t) * above + t * below) / 255);
      }
    }
  }
  return light;
}

/// What makes pictures of an arm difficult.
struct ClutterConfig {
  double noise = 2;       ///< Standard deviation in values of an 8-bit image.
  double psf = 0.7;       ///< px
  double gradient = 0.3;  ///< Relative change of the light from the picture's middle to its edges.
  double shadow = 0.4;    ///< Depth of soft shadows on the background.
  int cables = 2;         ///< Cables behind the arm, with the brightness of the arm.
  int wires = 1;          ///< Thin cables in front of the arm.
  double cast = 0;        ///< Depth of the arm's own shadow on the background.
  double plate = 0;       ///< Part of the arm that a plate in front of it covers, as a share of its length.
};

/// Pictures of an arm in front of clutter by two cameras, and of the clutter alone.
struct ClutteredArm {
  SeenShape shape;                                 ///< `pictures` in colour.
  std::array<Image<std::uint8_t>, 2> backgrounds;  ///< In slightly different light.
  std::array<std::vector<AxisPoint>, 2> truth;     ///< Images of the backbone.
  /// Colour of the arm in each picture, as a user would pick it: the median along the arm.
  std::array<Eigen::Vector3d, 2> seen_color;
};

namespace clutter_detail {

/// Blends a line from a to b, px, with a colour.
inline void draw_line(Image<float>& light, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width,
                      const Eigen::Vector3d& color) {
  const Eigen::Vector2d way = b - a;
  for (int v = 0; v < light.height(); ++v) {
    for (int u = 0; u < light.width(); ++u) {
      const Eigen::Vector2d p(u, v);
      const double t = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
      const double share = std::clamp(0.5 * width - (p - a - t * way).norm() + 0.5, 0.0, 1.0);
      if (share == 0) continue;
      for (int c = 0; c < 3; ++c) {
        float& value = light.at(u, v, c);
        value += static_cast<float>(share) * (static_cast<float>(color[c]) - value);
      }
    }
  }
}

/// Darkens the ground where the arm's image, moved by `off` px and blurred, is.
inline void cast_shadow(const Image<float>& black, const Image<float>& white, const Eigen::Vector2d& off,
                        double depth, Image<float>& ground) {
  constexpr int blur = 4;
  const auto covered = [&](int u, int v) {
    if (u < 0 || v < 0 || u >= black.width() || v >= black.height()) return 0.0;
    return 1.0 - (white.at(u, v, 0) - black.at(u, v, 0));
  };
  const int du = static_cast<int>(off.x()), dv = static_cast<int>(off.y());
  for (int v = 0; v < ground.height(); ++v) {
    for (int u = 0; u < ground.width(); ++u) {
      double sum = 0;
      for (int k = -blur; k <= blur; ++k) sum += covered(u - du + k, v - dv) + covered(u - du, v - dv + k);
      const double left = 1 - depth * sum / (2 * (2 * blur + 1));
      for (int c = 0; c < 3; ++c) ground.at(u, v, c) *= static_cast<float>(left);
    }
  }
}

/// Returns the median colour of the picture along the axis.
inline Eigen::Vector3d color_along(const std::vector<AxisPoint>& axis, const Image<std::uint8_t>& picture) {
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (std::size_t k = 0; k < axis.size(); k += 10) {
      if (!axis[k].pixel) continue;
      const int u = static_cast<int>(std::lround(axis[k].pixel->x())),
                v = static_cast<int>(std::lround(axis[k].pixel->y()));
      if (u >= 0 && v >= 0 && u < picture.width() && v < picture.height())
        values.push_back(picture.at(u, v, c));
    }
    std::ranges::sort(values);
    if (!values.empty()) color[c] = values[values.size() / 2];
  }
  return color;
}

inline Image<std::uint8_t> read_light(const Image<float>& light, const ClutterConfig& options,
                                      std::uint64_t seed) {
  SensorConfig config;
  config.width = light.width(), config.height = light.height();
  config.pixels = PixelKind::color;
  config.psf = options.psf, config.read_noise = options.noise;
  SensorRows rows;
  Image<std::uint8_t> picture(light.width(), light.height(), 3);
  Sensor(config).read(light, {seed, 0, 0}, rows, picture);
  return picture;
}

}  // namespace clutter_detail

/// Returns the arm of `shape` in front of clutter.
inline ClutteredArm cluttered_arm(TestRandom& random, const ClutterConfig& options) {
  using clutter_detail::draw_line;
  SeenArmConfig seen;
  RandomArm arm = random_arm(random, seen);
  ClutteredArm result;
  SeenShape& shape = result.shape;
  shape.bent = arm.bent, shape.noise = options.noise;
  const std::array<Eigen::Vector3d, 6> colors = {{{0.08, 0.08, 0.09},
                                                  {0.75, 0.75, 0.7},
                                                  {0.6, 0.1, 0.08},
                                                  {0.1, 0.4, 0.15},
                                                  {0.1, 0.2, 0.6},
                                                  {0.7, 0.35, 0.05}}};
  arm.scene.arm.albedo = colors[static_cast<std::size_t>(random.integer(0, 5))];
  const Backbone backbone = arm.bent.backbone();
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < 2; ++i) {
    const double angle =
        turn + static_cast<double>(i) * (0.5 * std::numbers::pi + random.uniform(-0.15, 0.15));
    const Eigen::Vector3d direction(std::cos(angle), random.uniform(-0.2, 0.2), std::sin(angle));
    const Eigen::Vector3d from = middle + direction.normalized() * random.uniform(1.5, 3);
    shape.views[i] = pinhole_view(
        look_at(from, middle + random.vector<3>(-0.05, 0.05)), seen.width, seen.height,
        0.42 * seen.height * (from - middle).norm() / (0.55 * backbone.length()) * random.uniform(0.7, 1));
    const View& view = shape.views[i];
    Renderer renderer;
    LightImage on_black, on_white;
    arm.scene.background = Color::Zero();
    renderer.render(arm.scene, view, PixelKind::color, on_black);
    arm.scene.background = Color::Ones();
    renderer.render(arm.scene, view, PixelKind::color, on_white);
    result.truth[i] = true_axis(arm.scene, view, 601);
    const auto& files = clutter_files();
    Image<float> ground =
        clutter_light(files[static_cast<std::size_t>(random.integer(0, static_cast<int>(files.size()) - 1))],
                      view.width, view.height);
    const DrawnTexture shade(static_cast<std::uint64_t>(random.integer(0, 1 << 30)), 120);
    for (int v = 0; v < view.height; ++v)
      for (int u = 0; u < view.width; ++u)
        for (int c = 0; c < 3; ++c)
          ground.at(u, v, c) *= static_cast<float>(1 - options.shadow * shade(u, v));
    const auto pixel = [&] {
      return Eigen::Vector2d(random.uniform(0, view.width), random.uniform(0, view.height));
    };
    for (int k = 0; k < options.cables; ++k)
      draw_line(ground, pixel(), pixel(), random.uniform(4, 14),
                arm.scene.arm.albedo * random.uniform(0.7, 1.1));
    std::array<Image<float>, 2> light = {ground, ground};  // With and without the arm.
    if (options.cast > 0)
      clutter_detail::cast_shadow(on_black.light, on_white.light, random.vector<2>(-40, 40), options.cast,
                                  ground);
    for (std::size_t k = 0; k < ground.values().size(); ++k) {
      const float black = on_black.light.values()[k], share = on_white.light.values()[k] - black;
      light[0].values()[k] = black + share * ground.values()[k];
    }
    std::vector<std::array<Eigen::Vector2d, 2>> wires;
    for (int k = 0; k < options.wires; ++k) wires.push_back({pixel(), pixel()});
    const double wire = random.uniform(2, 5);
    const Eigen::Vector3d wire_color = random.vector<3>(0.05, 0.9);
    const std::size_t from_point = static_cast<std::size_t>(random.uniform(0.1, 0.9 - options.plate) * 600),
                      to_point = from_point + static_cast<std::size_t>(options.plate * 600);
    const double falling = random.uniform(0, 2 * std::numbers::pi), other_light = random.uniform(0.93, 1.07);
    for (std::size_t k = 0; k < 2; ++k) {
      for (const auto& [a, b] : wires) draw_line(light[k], a, b, wire, wire_color);
      const auto &a = result.truth[i][from_point].pixel, &b = result.truth[i][to_point].pixel;
      if (options.plate > 0 && a && b && (*b - *a).norm() > 1)
        draw_line(light[k], *a, *b, 40, wire_color.reverse());
      for (int v = 0; v < view.height; ++v) {
        for (int u = 0; u < view.width; ++u) {
          const double x = 2.0 * u / view.width - 1, y = 2.0 * v / view.height - 1;
          const double gain = 1 + options.gradient * (x * std::cos(falling) + y * std::sin(falling));
          for (int c = 0; c < 3; ++c)
            light[k].at(u, v, c) *= static_cast<float>(0.85 * gain * (k == 0 ? 1 : other_light));
        }
      }
      (k == 0 ? shape.pictures : result.backgrounds)[i] = clutter_detail::read_light(
          light[k], options, static_cast<std::uint64_t>(random.integer(0, 1 << 30)));
    }
    result.seen_color[i] = clutter_detail::color_along(result.truth[i], shape.pictures[i]);
  }
  return result;
}

/// Returns the start of a fit: bends that are wrong by normal deviates of `std`, rad.
inline Shape guessed_shape(TestRandom& random, const BentArm& bent, double std) {
  Shape guess{bent.arm, bent.state};
  for (Eigen::Vector2d& bend : guess.state.bends)
    bend += std * Eigen::Vector2d(normal_number(random), normal_number(random));
  return guess;
}

/// Returns the distances of a shape's image from the true axis at `count` places, px.
inline std::vector<double> image_errors(const Shape& shape, const View& view,
                                        const std::vector<AxisPoint>& truth, int count = 100) {
  const Backbone backbone(shape.arm, shape.state);
  std::vector<double> errors;
  for (int k = 0; k <= count; ++k)
    if (const auto pixel = view.project(backbone.pose(backbone.length() * k / count).position))
      errors.push_back(std::abs(distance_to(truth, *pixel)));
  return errors;
}

}  // namespace flexura
