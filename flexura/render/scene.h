#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/look.h"
#include "flexura/model/obstacle.h"
#include "flexura/render/tube.h"

namespace flexura {

/// Red, green and blue: light in units of the sensor's full scale, or the reflected share of a surface.
/// Linear.
using Color = Eigen::Vector3d;

/// Returns the brightness of a colour to a gray sensor: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R
/// BT.709).
[[nodiscard]] inline double gray_of(const Color& color) {
  return 0.2126 * color.x() + 0.7152 * color.y() + 0.0722 * color.z();
}

/// A coloured ring on the arm's skin between two arc lengths.
struct MarkerRing {
  double s_from = 0, s_to = 0;  ///< Range of arc lengths, m from the base; s_from < s_to.
  Color albedo = {0.9, 0.05, 0.05};
};

/// A tendon guide: a short cylinder around the backbone.
struct GuideDisk {
  double s = 0;              ///< Position of its middle, m from the base.
  double radius = 0.03;      ///< Radius, m; > 0.
  double thickness = 0.004;  ///< Thickness, m; > 0.
};

/// Visible properties of the arm. An empty `tube` means no arm.
struct ArmLook {
  std::vector<Arc> tube;  ///< Arcs from the base on, each at the end of the previous one.
  TipKind tip = TipKind::flat;
  Color albedo = {0.16, 0.16, 0.17};
  Color disk_albedo = {0.35, 0.35, 0.37};
  std::vector<MarkerRing> markers;  ///< Where two overlap, the later one is visible.
  std::vector<GuideDisk> disks;
};

/// A finite white screen that emits light.
struct Screen {
  Pose X_WS;                                ///< Pose: origin in its middle, x to its right, z out of it.
  std::array<double, 2> size = {2, 2};      ///< Size along x and y, m; > 0.
  Color brightness = {0.85, 0.85, 0.85};    ///< Brightness in its middle.
  std::array<double, 2> gradient = {0, 0};  ///< Relative change from the middle to the edge at +x, +y.
  double falloff = 0;                       ///< Relative darkening in its corners.
};

/// The calibration cylinder: dark, with red lines along it in its +Z direction and every 90 degrees from
/// there.
struct Etalon {
  Pose X_WE;             ///< Pose: origin in its middle, axis along +Y.
  double radius = 0.05;  ///< Radius, m; > 0.
  double height = 0.3;   ///< Height, m; > 0.
  /// Line width around the surface, m; >= 0, less than a quarter of the circumference.
  double line_width = 0.004;
  Color albedo = {0.12, 0.12, 0.12};  ///< Colour of the cylinder.
  Color line_albedo = {0.8, 0.04, 0.04};
};

/// An obstacle with its colour.
struct VisibleObstacle {
  ObstacleConfig shape;  ///< Shape, in W.
  Color albedo = {0.4, 0.45, 0.4};
};

/// A surface shows albedo * (ambient + directional * max(0, cosine of its normal to the light)).
struct Light {
  Eigen::Vector3d direction = {0.4, 0.8, 0.45};  ///< Direction towards the light, W; not 0.
  double ambient = 0.45, directional = 0.55;     ///< Strengths, shares of full scale.
  /// Share of the directional light, or of a screen's, that a shadow removes; 0: no shadows. The arm casts
  /// shadows on everything. Disks, the etalon and obstacles other than planes cast them on screens and
  /// planes.
  double shadow = 0;
  /// Angular radius of the light, rad; > 0. Larger values give softer shadows.
  double angular_radius = 0.05;
};

/// All that a camera can see, in W.
struct Scene {
  ArmLook arm;
  std::vector<Screen> screens;
  std::optional<Etalon> etalon;
  std::vector<VisibleObstacle> obstacles;
  Light light;
  Color background = {0.02, 0.02, 0.02};  ///< Colour where there is no surface.
};

/// Throws std::invalid_argument, naming the part and the value, for invalid scenes. Invalid are: values that
/// are not finite, sizes that are not positive, sizes and positions beyond 1e9 m, directions of length zero.
/// Also invalid rotations, and tube arcs that do not continue each other.
void check(const Scene& scene);
/// Throws std::invalid_argument for an invalid camera pose.
void check_camera(const Pose& X_WC);

}  // namespace flexura
