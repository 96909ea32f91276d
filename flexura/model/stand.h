#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/look.h"

namespace flexura {

/// A flat, finite white screen behind the arm, visible from both sides.
struct ScreenConfig {
  std::array<double, 3> center = {0, 0, 0};  ///< Centre in W, m.
  std::array<double, 3> normal = {0, 0,
                                  /// Normal of the screen's front, in W. The direction of the screen's height
                                  /// points along W's Y as far as possible.
                                  1};
  double width = 1, height = 1;  ///< Size, m.
  double brightness = 0.85;      ///< Emitted light; 1 is a camera's full scale.
  /// Relative increase of brightness from the screen's middle to the right edge and to the upper edge.
  std::array<double, 2> gradient = {0, 0};
  double fall_off = 0;  ///< Relative loss of brightness in the corners.
};

/// The calibration cylinder: dark gray, with four red lines parallel to its axis. E is the cylinder's frame.
struct EtalonConfig {
  /// Centre of the cylinder's lower end in W, the origin of E, m.
  std::array<double, 3> position = {0, 0, 0};
  /// Quaternion (w, x, y, z) of R_WE; the cylinder's axis is E's +Y.
  std::array<double, 4> rotation = {1, 0, 0, 0};
  double radius = 0.1;  ///< Radius, m.
  double height = 0.4;  ///< Height, m.
  ColorConfig color = {0.1, 0.1, 0.1};
  /// Width of a line around the cylinder, m. The lines are at every 90 degrees around the axis, beginning at
  /// E's +Z.
  double line_width = 0.01;
  ColorConfig line_color = {0.75, 0.08, 0.08};  ///< Colour of the lines.
};

/// Light on the arm, the calibration cylinder and the obstacles. Screens have their own brightness.
struct LightConfig {
  /// Ambient light, equal from all directions. With 1, a white surface reaches a camera's full scale.
  double ambient = 0.45;
  double directional = 0.55;  ///< Directional light on a surface that faces the source.
  /// Direction to the source of the directional light, in W.
  std::array<double, 3> towards = {0.4, 0.8, 0.45};
  double shadow = 0;  ///< Fraction of the directional light, and of a screen's light, that a shadow removes.
  double angular_radius = 0.05;  ///< Half the angular size of the light source, rad.
};

/// Surroundings of the arm.
struct StandConfig {
  std::optional<std::vector<ScreenConfig>>
      screen;                          ///< Screens; default: two behind the arm (default_screens).
  std::optional<EtalonConfig> etalon;  ///< Calibration cylinder; default: none.
  LightConfig light;
  /// Distances D1 and D2 of the default cameras from the planes XOY and ZOY through the arm's base, as in the
  /// paper, m. Default: large enough to show the arm's whole reach.
  std::optional<std::array<double, 2>> camera_distances;
  double background = 0.02;  ///< Light from directions without an object; 1 is a camera's full scale.
  bool arm = true;  ///< Whether the arm is in the scene. Calibrations with the cylinder remove the arm.
};

const Table<ScreenConfig>& fields_of(const ScreenConfig*);
const Table<EtalonConfig>& fields_of(const EtalonConfig*);
const Table<LightConfig>& fields_of(const LightConfig*);
const Table<StandConfig>& fields_of(const StandConfig*);

/// Returns the paper's two white screens behind an arm with a reach of `length` m from `base` (p_WB, m). One
/// screen fills the view along -Z, the other the view along +X.
[[nodiscard]] std::vector<ScreenConfig> default_screens(double length, const std::array<double, 3>& base);

}  // namespace flexura
