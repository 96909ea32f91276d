#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/random_cases.h"

namespace flexura {

/// How a camera truly starts, beside where it is believed to be: angles in rad, the stage in m.
struct WrongStart {
  double pan = 0, tilt = 0, roll = 0, zoom = 1, cx = 0, cy = 0;
  std::array<double, 3> shift = {0, 0, 0};
};

/// Evenly over what the paper's methods shall start from: pan and tilt 10 degrees off, roll 1, the stage 0.2
/// m in each direction, zoom 1 to 2.5, the principal point 1 px; `size` is a share of all that.
inline WrongStart wrong_start(TestRandom& random, double size = 1) {
  constexpr double degree = std::numbers::pi / 180;
  WrongStart start;
  start.pan = size * random.uniform(-10, 10) * degree, start.tilt = size * random.uniform(-10, 10) * degree;
  start.roll = size * random.uniform(-1, 1) * degree, start.zoom = 1 + size * random.uniform(0, 1.5);
  start.cx = size * random.uniform(-1, 1), start.cy = size * random.uniform(-1, 1);
  for (double& way : start.shift) way = size * random.uniform(-0.2, 0.2);
  return start;
}

/// A camera of `loop_rig`, as believed or, with `wrong`, as it truly is: its head and stage count from there.
inline std::string loop_camera(const std::string& name, double distance, bool is_side,
                               const WrongStart* wrong, const std::string& sensor) {
  const double middle = 0.5;
  std::array<double, 3> at = {0, middle, 0};
  const double c = is_side ? 1 : 0, s = is_side ? 0 : 1;  // Looks along c X - s Z.
  at[0] -= c * distance, at[2] += s * distance;
  std::array<double, 3> look = {0, 0, 0};
  const double pan = wrong != nullptr ? wrong->pan : 0, tilt = wrong != nullptr ? wrong->tilt : 0;
  const double heading = (is_side ? 0 : std::numbers::pi / 2) + pan;  // Of the sight from +X, to the left.
  look = {std::cos(tilt) * std::cos(heading), std::sin(tilt), -std::cos(tilt) * std::sin(heading)};
  if (wrong != nullptr)
    for (std::size_t i = 0; i < 3; ++i) at[i] += wrong->shift[i];
  std::string text = fmt::format(
      "name = \"{}\"\nmount = {{ position = [{}, {}, {}], look_at = [{}, {}, {}], roll = {}, "
      "stage = {{ x = {{ limits = [-0.6, 0.6] }}, y = {{ limits = [-0.6, 0.6] }}, z = {{ limits = [-0.6, "
      "0.6] }} }} }}\n",
      name, at[0], at[1], at[2], at[0] + look[0], at[1] + look[1], at[2] + look[2],
      wrong != nullptr ? wrong->roll : 0.0);
  text +=
      fmt::format("lens = {{ fx = 800, cx = {}, cy = {} }}\n", 319.5 + (wrong != nullptr ? wrong->cx : 0.0),
                  239.5 + (wrong != nullptr ? wrong->cy : 0.0));
  if (wrong != nullptr) return "[[truth.camera]]\n" + text;
  text +=
      "head = { pan = { limits_deg = [-90, 90], max_rate_deg = 200, resolution_deg = 0.075 }, tilt = { "
      "limits_deg = "
      "[-45, 45], max_rate_deg = 200, resolution_deg = 0.075 } }\n"
      "sensor = { width = 640, height = 480, pixels = \"color\", frame_rate = 20, psf = 0.7, read_noise = 2, "
      "full_well = 20000" +
      sensor + " }\n";
  return "[[camera]]\n" + text;
}

/// Two cameras before the calibration cylinder, wrong as said, whose task calibrates them.
inline std::string etalon_rig(const std::string& task, const std::array<WrongStart, 2>& wrong,
                              const std::string& stand = "", const std::string& sensor = "",
                              double distance = 1.5) {
  std::string text =
      "[arm]\nkind = \"spatial\"\n[[arm.section]]\nlength = 1\nradius = 0.03\n"
      "[stand]\narm = false\n[stand.etalon]\nposition = [0, 0.3, 0]\n" +
      stand +
      "[[stand.screen]]\ncenter = [0, 0.5, -1.5]\nnormal = [0, 0, 1]\nwidth = 9\nheight = 9\n"
      "[[stand.screen]]\ncenter = [1.5, 0.5, 0]\nnormal = [-1, 0, 0]\nwidth = 9\nheight = 9\n";
  for (const bool is_side : {false, true}) {
    std::string camera = loop_camera(is_side ? "side" : "front", distance, is_side, nullptr, sensor);
    text += camera + fmt::format("initial = {{ zoom = {} }}\n", wrong[is_side ? 1 : 0].zoom);
  }
  for (const bool is_side : {false, true})
    text += loop_camera(is_side ? "side" : "front", distance, is_side, &wrong[is_side ? 1 : 0], sensor);
  return text + "\n[[task]]\nkind = \"calibrate\"\n" + task;
}

}  // namespace flexura
