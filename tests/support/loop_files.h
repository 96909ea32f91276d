#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Initial errors of a camera relative to its model: angles in rad, the stage in m.
struct WrongStart {
  double pan = 0, tilt = 0, roll = 0, zoom = 1, cx = 0, cy = 0;
  std::array<double, 3> shift = {0, 0, 0};
  // Not drawn by wrong_start:
  double pan_zero = 0, tilt_zero = 0;           ///< Zero errors of the head, rad.
  std::array<double, 3> tilt_axis = {0, 0, 0};  ///< Error of a point of the tilt axis, m.
  double k1 = 0;                                ///< Distortion of the lens.
  double focal = 1;                             ///< Factor on the focal length.
};

/// Returns errors distributed uniformly over the starting range of the paper's methods. Pan and tilt: 10
/// degrees; roll: 1 degree; stage: 0.2 m in each direction; zoom: 1 to 2.5; principal point: 1 px. `size`
/// scales all of them.
inline WrongStart wrong_start(TestRandom& random, double size = 1) {
  WrongStart start;
  start.pan = size * random.uniform(-10, 10) * degree, start.tilt = size * random.uniform(-10, 10) * degree;
  start.roll = size * random.uniform(-1, 1) * degree, start.zoom = 1 + size * random.uniform(0, 1.5);
  start.cx = size * random.uniform(-1, 1), start.cy = size * random.uniform(-1, 1);
  for (double& way : start.shift) way = size * random.uniform(-0.2, 0.2);
  return start;
}

/// A rig with wrong cameras and an arm with relative errors of lengths and bends.
struct WrongRig {
  WrongStart front, side;
  std::array<double, 3> longer = {};
  std::vector<double> gains = {1, 1, 1};
};

/// Returns uniformly distributed errors: lengths 0.5 %, bends 1 %.
inline WrongRig wrong_rig(TestRandom& random) {
  WrongRig rig;
  rig.front = wrong_start(random), rig.side = wrong_start(random);
  for (double& share : rig.longer) share = random.uniform(-0.005, 0.005);
  for (double& gain : rig.gains) gain = 1 + random.uniform(-0.01, 0.01);
  return rig;
}

/// A rig for the paper's methods: two cameras of 640 x 480 px, or smaller.
struct LoopRig {
  std::array<WrongStart, 2> wrong = {};  ///< Initial errors of the cameras.
  std::array<std::array<double, 3>, 2> at = {
      {{0, 0.5, 1.5}, {-1.5, 0.5, 0}}};  ///< Nominal camera positions, m.
  double size = 1;                       ///< Scale of the picture size.
  double travel = 0.6;                   ///< Travel of the stages to both sides, m.
  std::string sensor = {};               ///< Additional sensor settings, for example ", drop = 1".
  double frame_rate = 20;                ///< 1/s
};

/// Returns a camera of the rig, nominal or true; head and stage positions count from there.
inline std::string loop_camera(const LoopRig& rig, bool is_side, bool is_truth) {
  const std::size_t i = is_side ? 1 : 0;
  const WrongStart wrong = is_truth ? rig.wrong[i] : WrongStart{};
  std::array<double, 3> at = rig.at[i];
  for (std::size_t j = 0; j < 3; ++j) at[j] += wrong.shift[j];
  const double heading =
      (is_side ? 0 : std::numbers::pi / 2) + wrong.pan;  // Of the line of sight from +X, to the left.
  const std::array<double, 3> look = {at[0] + std::cos(wrong.tilt) * std::cos(heading),
                                      at[1] + std::sin(wrong.tilt),
                                      at[2] - std::cos(wrong.tilt) * std::sin(heading)};
  const std::string slide = fmt::format("{{ limits = [{}, {}] }}", -rig.travel, rig.travel);
  std::string text = fmt::format(
      "name = \"{}\"\nmount = {{ position = [{}, {}, {}], look_at = [{}, {}, {}], roll = {}, stage = {{ x = "
      "{}, y = {}, z = {} }} }}\nlens = {{ fx = {}, cx = {}, cy = {}, distortion = [{}, 0, 0, 0, 0] }}\n",
      is_side ? "side" : "front", at[0], at[1], at[2], look[0], look[1], look[2], wrong.roll, slide, slide,
      slide, 800 * rig.size * wrong.focal, 320 * rig.size - 0.5 + wrong.cx, 240 * rig.size - 0.5 + wrong.cy,
      wrong.k1);
  if (is_truth)
    return fmt::format(
        "[[truth.camera]]\n{}head = {{ pan = {{ zero = {} }}, tilt = {{ zero = {} }}, tilt_axis = [{}] }}\n",
        text, wrong.pan_zero, wrong.tilt_zero, fmt::join(wrong.tilt_axis, ", "));
  text += fmt::format(
      "head = {{ pan = {{ limits_deg = [-90, 90], max_rate_deg = 200, resolution_deg = 0.075 }}, tilt = {{ "
      "limits_deg = [-45, 45], max_rate_deg = 200, resolution_deg = 0.075 }} }}\n"
      "sensor = {{ width = {}, height = {}, pixels = \"color\", frame_rate = {}, psf = 0.7, read_noise = 2, "
      "full_well = 20000{} }}\ninitial = {{ zoom = {} }}\n",
      static_cast<int>(640 * rig.size), static_cast<int>(480 * rig.size), rig.frame_rate, rig.sensor,
      rig.wrong[i].zoom);
  return "[[camera]]\n" + text;
}

inline std::string loop_rig(const LoopRig& rig, const std::string& task) {
  std::string text =
      "[[stand.screen]]\ncenter = [0, 0.5, -1.5]\nnormal = [0, 0, 1]\nwidth = 9\nheight = 9\n"
      "[[stand.screen]]\ncenter = [1.5, 0.5, 0]\nnormal = [-1, 0, 0]\nwidth = 9\nheight = 9\n";
  for (const bool is_truth : {false, true})
    for (const bool is_side : {false, true}) text += loop_camera(rig, is_side, is_truth);
  return text + "\n[[task]]\nkind = \"calibrate\"\n" + task;
}

/// Returns a file of the rig in front of the calibration cylinder.
inline std::string etalon_rig(const std::string& task, const LoopRig& rig, const std::string& etalon = "") {
  return "[arm]\nkind = \"spatial\"\n[[arm.section]]\nlength = 1\nradius = 0.03\n"
         "[stand]\narm = false\n[stand.etalon]\nposition = [0, 0.3, 0]\n" +
         etalon + loop_rig(rig, task);
}

/// Returns a file of the rig in front of a three-section arm with bands in three colours, which bends into
/// arcs of 120 degrees. `truth`: the true arm lengths.
inline std::string arcs_rig(const std::string& task, const LoopRig& rig,
                            const std::array<double, 3>& longer = {}) {
  std::string text = "[arm]\nkind = \"spatial\"\n", truth;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = i < 2 ? 0.35 : 0.3;
    text += fmt::format("[[arm.section]]\nlength = {}\nradius = 0.02\nmax_bend_deg = 120\n", length);
    truth += fmt::format("[[truth.arm.section]]\nlength = {}\n", length * (1 + longer[i]));
  }
  return text +
         "[arm.look]\nbands = { per_section = 4, width = 0.02, colors = [[0.85, 0.1, 0.1], [0.1, 0.6, 0.15], "
         "[0.1, 0.2, 0.85]] }\n" +
         truth + loop_rig(rig, task);
}

/// Returns cameras 2.5 m away that look straight at the middle of both arcs, or at the centres of their
/// circles.
inline LoopRig arcs_cameras(const std::array<WrongStart, 2>& wrong, bool is_at_centers = false) {
  const double radius = 1 / (2 * std::numbers::pi / 3);
  const double aside = is_at_centers ? radius : 0.5 * radius,
               up = is_at_centers ? 0 : radius * std::sqrt(0.75);
  LoopRig rig;
  rig.wrong = wrong, rig.at = {{{aside, up, 2.5}, {-2.5, up, -aside}}};
  return rig;
}

}  // namespace flexura
