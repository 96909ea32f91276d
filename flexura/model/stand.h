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
  std::array<double, 3> center = {0, 0, 0};  ///< m, in W.
  std::array<double, 3> normal = {
      0, 0, 1};                  ///< Its front's normal, in W; its height is along W's Y as far as possible.
  double width = 1, height = 1;  ///< m.
  double brightness = 0.85;      ///< Emitted light, in shares of a camera's full scale.
  std::array<double, 2> gradient = {
      0, 0};  ///< Relative increase of brightness from its middle to its right and to its upper edge.
  double fall_off = 0;  ///< Share by which its corners are darker than its middle.
};

/// The calibration cylinder: dark gray, with red lines along it.
struct EtalonConfig {
  std::array<double, 3> position = {0, 0, 0};     ///< Middle of its lower end, m.
  std::array<double, 4> rotation = {1, 0, 0, 0};  ///< Quaternion (w, x, y, z), E to W: the axis is E's +Y.
  double radius = 0.1;                            ///< m.
  double height = 0.4;                            ///< m.
  ColorConfig color = {0.1, 0.1, 0.1};
  double line_width =
      0.01;  ///< m around the cylinder; one line towards E's +Z and one every 90 degrees from there.
  ColorConfig line_color = {0.75, 0.08, 0.08};  ///< Colour of the lines.
};

/// Light on the arm, the etalon and the obstacles; screens have their own brightness.
struct LightConfig {
  double ambient = 0.45;                             ///< From all directions.
  double directional = 0.55;                         ///< From one direction, on a surface that faces it.
  std::array<double, 3> towards = {0.4, 0.8, 0.45};  ///< Direction to its source, in W.
  double shadow = 0;  ///< Share of the directional light, and of a screen's, that a shadow removes.
  double angular_radius = 0.05;  ///< Half the angular size of the light's source, rad.
};

/// Surroundings of the arm.
struct StandConfig {
  std::optional<std::vector<ScreenConfig>> screen;  ///< Default: two behind the arm (default_screens).
  std::optional<EtalonConfig> etalon;               ///< Default: no etalon.
  LightConfig light;
  /// Distances of the default cameras from the planes XOY and ZOY through the arm's base, the paper's D1 and
  /// D2, m. Default: far enough to have the whole reach of the arm in view.
  std::optional<std::array<double, 2>> camera_distances;
  double background = 0.02;  ///< Light from directions without an object.
  bool arm = true;           ///< The arm is present. (Etalon calibrations remove it.)
};

const Table<ScreenConfig>& fields_of(const ScreenConfig*);
const Table<EtalonConfig>& fields_of(const EtalonConfig*);
const Table<LightConfig>& fields_of(const LightConfig*);
const Table<StandConfig>& fields_of(const StandConfig*);

/// Returns the paper's two white screens, behind an arm with a reach of `length` m from `base` (p_WB): one
/// closes the view along -Z, one along +X.
[[nodiscard]] std::vector<ScreenConfig> default_screens(double length, const std::array<double, 3>& base);

}  // namespace flexura
