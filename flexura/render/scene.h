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

/// Linear red, green and blue: light in units of the sensor's full scale, or the reflected fractions of a
/// surface (albedo).
using Color = Eigen::Vector3d;

/// Returns the brightness of a colour for a gray sensor: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R
/// BT.709).
[[nodiscard]] inline double gray_of(const Color& color) {
  return 0.2126 * color.x() + 0.7152 * color.y() + 0.0722 * color.z();
}

/// A coloured ring on the arm's surface between two arc lengths.
struct MarkerRing {
  double s_from = 0, s_to = 0;  ///< Range of arc lengths, m from the base; s_from < s_to.
  Color albedo = {0.9, 0.05, 0.05};
};

/// A guide disk for tendons: a short cylinder around the backbone.
struct GuideDisk {
  double s = 0;              ///< Arc length of the disk's middle from the base, m.
  double radius = 0.03;      ///< Radius, m; > 0.
  double thickness = 0.004;  ///< Thickness, m; > 0.
};

/// Visible properties of the arm. An empty `tube` means that there is no arm.
struct ArmLook {
  std::vector<Arc> tube;  ///< Arcs from base to tip. Each arc starts at the end of the previous arc.
  TipKind tip = TipKind::flat;
  Color albedo = {0.16, 0.16, 0.17};
  Color disk_albedo = {0.35, 0.35, 0.37};
  std::vector<MarkerRing>
      markers;  ///< Coloured rings. Where two rings overlap, the later ring in the list is visible.
  std::vector<GuideDisk> disks;
};

/// A finite white screen that emits light.
struct Screen {
  /// Pose of the screen's frame: origin in the middle, x to the right, z along the front's normal.
  Pose X_WS;
  std::array<double, 2> size = {2, 2};    ///< Size along x and y, m; > 0.
  Color brightness = {0.85, 0.85, 0.85};  ///< Brightness in the screen's middle.
  std::array<double, 2> gradient = {
      0, 0};           ///< Relative change of brightness from the middle to the edges at +x and +y.
  double falloff = 0;  ///< Relative loss of brightness in the corners.
};

/// The calibration cylinder: dark, with red lines parallel to its axis. The lines are at every 90 degrees
/// around the axis, beginning at +Z of the cylinder's frame E.
struct Etalon {
  Pose X_WE;             ///< Pose of the cylinder's frame E: origin in the middle, axis along +Y.
  double radius = 0.05;  ///< Radius, m; > 0.
  double height = 0.3;   ///< Height, m; > 0.
  /// Width of a line around the surface, m; >= 0 and less than a quarter of the circumference.
  double line_width = 0.004;
  Color albedo = {0.12, 0.12, 0.12};  ///< Colour of the cylinder.
  Color line_albedo = {0.8, 0.04, 0.04};
};

/// An obstacle with its colour.
struct VisibleObstacle {
  ObstacleConfig shape;  ///< Shape, in W.
  Color albedo = {0.4, 0.45, 0.4};
};

/// Light on surfaces. A surface has the brightness albedo * (ambient + directional * max(0, cosine of the
/// angle between its normal and the light)).
struct Light {
  /// Direction towards the light source, in W. The length of this vector must be above 0.
  Eigen::Vector3d direction = {0.4, 0.8, 0.45};
  /// Ambient and directional light; 1 is full scale on a white surface.
  double ambient = 0.45, directional = 0.55;
  /// Fraction of the directional light, and of a screen's light, that a shadow removes; 0: no shadows. The
  /// arm casts shadows on all surfaces. Guide disks, the calibration cylinder and obstacles other than planes
  /// cast shadows only on screens and planes.
  double shadow = 0;
  /// Angular radius of the light source, rad; > 0. A larger source makes softer shadows.
  double angular_radius = 0.05;
};

/// Everything that a camera can see, in W.
struct Scene {
  ArmLook arm;
  std::vector<Screen> screens;
  std::optional<Etalon> etalon;
  std::vector<VisibleObstacle> obstacles;
  Light light;
  Color background = {0.02, 0.02, 0.02};  ///< Light from directions without a surface.
};

/// Throws std::invalid_argument for an invalid scene. The message names the part and the value. Errors are
/// values that are not finite, sizes that are not positive, sizes and positions above 1e9 m, and directions
/// of length zero. Further errors are matrices that are not rotations, and tube arcs that do not start at the
/// end of the previous arc.
void check(const Scene& scene);
/// Throws std::invalid_argument for a camera pose that is not finite or not a rigid transform.
void check_camera(const Pose& X_WC);

}  // namespace flexura
