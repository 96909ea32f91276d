#pragma once

#include <algorithm>
#include <cstddef>

#include "flexura/base/image.h"
#include "flexura/camera/view.h"
#include "flexura/model/backbone.h"
#include "flexura/render/scene.h"

namespace flexura {

/// An arm of 1 m in three sections, with twelve rings, in front of a white screen. It is 2 cm thick from its
/// middle on and covers a fifth of the image.
struct Setting {
  Scene scene;
  View view;
};

inline Arm setting_arm() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (std::size_t i = 0; i < 3; ++i) {
    Section& section = arm.sections.emplace_back();
    section.length = 1.0 / 3;
    section.radius = {0.02, 0.02};
  }
  return arm;
}

inline ArmState setting_state() { return {{{1.5, 0.1}, {2.0, -0.2}, {2.0, 0.2}}, {1, 1, 1}}; }

inline Setting setting(int width, int height) {
  const Arm arm = setting_arm();
  Setting result;
  result.scene.arm.tube = tube_of(Backbone(arm, setting_state()));
  for (int i = 0; i < 12; ++i) {
    const double s = (i + 0.5) / 12;
    result.scene.arm.markers.push_back({s - 0.008, s + 0.008});
  }
  Screen& screen = result.scene.screens.emplace_back();
  screen.X_WS.position = {0, 0.4, -0.5};
  screen.size = {4, 4};
  // Camera on +Z looking along -Z: x to the right, y down.
  result.view.X_WC.rotation << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  result.view.X_WC.position = {0.19, 0.054, 1.5};
  result.view.width = width, result.view.height = height;
  const double focal = 3.85 * height;
  result.view.lens = Lens({focal, focal, 0.5 * (width - 1), 0.5 * (height - 1)});
  return result;
}

/// Returns a laboratory setting: the same arm, less bent and with twelve bands in three colours, seen from
/// 2.5 m by one of two cameras. The edges of both their screens are visible. `tip` is the ratio of the radii
/// at tip and base; the arm tapers linearly.
inline Setting laboratory_setting(int width, int height, double tip = 1) {
  Arm arm = setting_arm();
  const double sections = static_cast<double>(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i)
    for (std::size_t end = 0; end < 2; ++end)
      arm.sections[i].radius[end] *= 1 + (tip - 1) * static_cast<double>(i + end) / sections;
  const ArmState state{{{0.6, 0.4}, {-0.8, 0.5}, {0.9, -0.6}}, {1, 1, 1}};
  Setting result;
  result.scene.arm.tube = tube_of(Backbone(arm, state));
  const Color colors[3] = {{0.85, 0.1, 0.1}, {0.1, 0.6, 0.15}, {0.1, 0.2, 0.85}};
  for (int i = 0; i < 12; ++i) {
    const double s = (i + 0.5) / 12;
    result.scene.arm.markers.push_back({s - 0.007, s + 0.007, colors[i % 3]});
  }
  for (const bool is_side : {false, true}) {
    Screen& screen = result.scene.screens.emplace_back();
    screen.size = {1.6, 3};
    if (is_side) screen.X_WS.rotation << 0, 0, -1, 0, 1, 0, 1, 0, 0;
    screen.X_WS.position = is_side ? Eigen::Vector3d(1, 0.5, 0) : Eigen::Vector3d(0, 0.5, -1);
  }
  result.view.X_WC.rotation << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  result.view.X_WC.position = {0, 0.5, 2.5};
  result.view.width = width, result.view.height = height;
  const double focal = 1.67 * height;
  result.view.lens = Lens({focal, focal, 0.5 * (width - 1), 0.5 * (height - 1)});
  return result;
}

/// Depth that separates the arm (nearer) from the screen (beyond), m.
inline constexpr float screen_begins = 1.9f;

/// Returns the share of the pixels that show the arm.
inline double covered_share(const Image<float>& depth) {
  const auto count = std::ranges::count_if(depth.values(), [](float one) { return one < screen_begins; });
  return static_cast<double>(count) / static_cast<double>(depth.values().size());
}

}  // namespace flexura
