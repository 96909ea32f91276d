#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/look.h"

namespace flexura {

/// A flat, finite white screen behind the arm, seen from both sides.
struct ScreenConfig {
  std::array<double, 3> center = {0, 0, 0};  ///< m, in W.
  std::array<double, 3> normal = {
      0, 0, 1};                  ///< The way it faces, in W; its height runs along W's Y as far as it can.
  double width = 1, height = 1;  ///< m
  double brightness = 0.85;      ///< Light that it sends, in shares of a camera's full scale.
  std::array<double, 2> gradient = {
      0, 0};  ///< Share by which it grows brighter from its middle to its right and to its upper edge.
  double fall_off = 0;  ///< Share by which its corners are darker than its middle.
};

/// The calibration cylinder: dark grey, with red lines along it.
struct EtalonConfig {
  std::array<double, 3> position = {0, 0, 0};     ///< Middle of its lower end, m.
  std::array<double, 4> rotation = {1, 0, 0, 0};  ///< Quaternion (w, x, y, z), E into W: the axis is E's +Y.
  double radius = 0.1;                            ///< m
  double height = 0.4;                            ///< m
  ColorConfig color = {0.1, 0.1, 0.1};
  double line_width =
      0.01;  ///< m around the cylinder; a line towards E's +Z and every 90 degrees from there.
  ColorConfig line_color = {0.75, 0.08, 0.08};  ///< Of the lines.
};

/// The light on the arm, the etalon and the obstacles; screens have a brightness of their own.
struct LightConfig {
  double ambient = 0.45;                             ///< From everywhere.
  double directional = 0.55;                         ///< From one direction, on a surface that faces it.
  std::array<double, 3> towards = {0.4, 0.8, 0.45};  ///< Where it comes from, in W.
  double shadow = 0;  ///< Share of the directional light, and of a screen's, that a shadow takes away.
  double angular_radius = 0.05;  ///< Half the angle under which the light's source is seen, rad.
};

/// What stands around the arm.
struct StandConfig {
  std::optional<std::vector<ScreenConfig>> screen;  ///< Left out: two behind the arm (default_screens).
  std::optional<EtalonConfig> etalon;               ///< Left out: there is none.
  LightConfig light;
  /// Of the default cameras from the planes XOY and ZOY through the arm's base, the paper's D1 and D2, m.
  /// Left out: so far that all of the arm's reach is in view.
  std::optional<std::array<double, 2>> camera_distances;
  double background = 0.02;  ///< Light from where nothing is.
  bool arm = true;           ///< The arm is there. (Etalon calibrations take it away.)
};

const Table<ScreenConfig>& fields_of(const ScreenConfig*);
const Table<EtalonConfig>& fields_of(const EtalonConfig*);
const Table<LightConfig>& fields_of(const LightConfig*);
const Table<StandConfig>& fields_of(const StandConfig*);

/// The paper's two white screens, behind an arm that reaches `length` m from `base` (p_WB): one that closes
/// the view along -Z, one along +X.
[[nodiscard]] std::vector<ScreenConfig> default_screens(double length, const std::array<double, 3>& base);

}  // namespace flexura
