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

/// Red, green and blue: light in units of the sensor's full scale, or the share of it that a surface
/// reflects. Linear.
using Color = Eigen::Vector3d;

/// The brightness of a colour to a gray sensor: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R BT.709).
[[nodiscard]] inline double gray_of(const Color& color) {
  return 0.2126 * color.x() + 0.7152 * color.y() + 0.0722 * color.z();
}

/// A ring of colour on the arm's skin between two arc lengths.
struct MarkerRing {
  double s_from = 0, s_to = 0;  ///< m from the base; s_from < s_to.
  Color albedo = {0.9, 0.05, 0.05};
};

/// A tendon guide: a short cylinder around the backbone.
struct GuideDisk {
  double s = 0;              ///< Of its middle, m from the base.
  double radius = 0.03;      ///< m; > 0.
  double thickness = 0.004;  ///< m; > 0.
};

/// The arm as it is seen. Empty `tube`: none.
struct ArmLook {
  std::vector<Arc> tube;  ///< From the base on, each arc at the end of the one before.
  TipKind tip = TipKind::flat;
  Color albedo = {0.16, 0.16, 0.17};
  Color disk_albedo = {0.35, 0.35, 0.37};
  std::vector<MarkerRing> markers;  ///< Where two overlap the later one is seen.
  std::vector<GuideDisk> disks;
};

/// A finite white screen: it shines by itself.
struct Screen {
  Pose X_WS;                              ///< Origin in its middle, x to its right, z out of it.
  std::array<double, 2> size = {2, 2};    ///< Along x and y, m; > 0.
  Color brightness = {0.85, 0.85, 0.85};  ///< In its middle.
  std::array<double, 2> gradient = {0,
                                    0};  ///< Share by which it changes from the middle to the edge at +x, +y.
  double falloff = 0;                    ///< Share by which it is darker in its corners.
};

/// The calibration cylinder: dark, with red lines along it in its +Z direction and every 90 degrees from
/// there.
struct Etalon {
  Pose X_WE;                  ///< Origin in its middle, axis along +Y.
  double radius = 0.05;       ///< m; > 0.
  double height = 0.3;        ///< m; > 0.
  double line_width = 0.004;  ///< Around the surface, m; at least 0, under a quarter of the way around.
  Color albedo = {0.12, 0.12, 0.12};  ///< Of the cylinder, and of the lines.
  Color line_albedo = {0.8, 0.04, 0.04};
};

/// An obstacle as cameras see it.
struct VisibleObstacle {
  ObstacleConfig shape;  ///< In W.
  Color albedo = {0.4, 0.45, 0.4};
};

/// A surface shows albedo * (ambient + directional * max(0, cosine of its normal to the light)).
struct Light {
  Eigen::Vector3d direction = {0.4, 0.8, 0.45};  ///< Towards the light, W; not 0.
  double ambient = 0.45, directional = 0.55;     ///< Shares of full scale.
  /// Share of the directional light, or of a screen's, that a shadow takes away; 0: no shadows. The arm
  /// casts them on everything; disks, the etalon and obstacles other than planes on screens and planes.
  double shadow = 0;
  double angular_radius = 0.05;  ///< Of the light, rad; the wider, the softer the shadows. > 0.
};

/// All that a camera can see, in W.
struct Scene {
  ArmLook arm;
  std::vector<Screen> screens;
  std::optional<Etalon> etalon;
  std::vector<VisibleObstacle> obstacles;
  Light light;
  Color background = {0.02, 0.02, 0.02};  ///< Where nothing is seen.
};

/// std::invalid_argument, naming the part and the value: a number that is not finite, a size that is not
/// positive, sizes and places beyond 1e9 m, a direction of length zero, a rotation that is none, tube arcs
/// that do not continue each other.
void check(const Scene& scene);
/// The same of where a camera stands.
void check_camera(const Pose& X_WC);

}  // namespace flexura
