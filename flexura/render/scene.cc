#include "flexura/render/scene.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "flexura/model/arm.h"

namespace flexura {
namespace {

template <typename... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> message, Args&&... args) {
  throw std::invalid_argument(fmt::format(message, std::forward<Args>(args)...));
}

// Subject of a message: a part of the scene, its number if there are several, and one of its values. Only
// string constants: no text is composed before there is an error.
struct Place {
  const char* part = "";
  const char* value = nullptr;
  std::optional<std::size_t> index{};

  [[nodiscard]] std::string text() const {
    std::string result = index ? fmt::format("{} {}", part, *index) : part;
    if (value != nullptr) result += fmt::format(", {}", value);
    return result;
  }
};

void require_positive(double value, const Place& place) {
  if (!(value > 0) || !std::isfinite(value)) refuse("{}: {} is not a positive number", place.text(), value);
}

// Values in files are at most 1e6 m. Far beyond, squares and sums lose precision.
constexpr double largest = 1e9;  // m

void require_size(double value, const Place& place) {
  require_positive(value, place);
  if (value > largest) refuse("{}: {} is more than {} m", place.text(), value, largest);
}

void require_finite(double value, const Place& place) {
  if (!std::isfinite(value)) refuse("{}: {} is not a finite number", place.text(), value);
}

void require_near(const Eigen::Vector3d& p, const Place& place) {
  if (!p.allFinite() || p.cwiseAbs().maxCoeff() > largest)
    refuse("{}: ({}, {}, {}) is not a place within {} m", place.text(), p.x(), p.y(), p.z(), largest);
}

void require_color(const Color& color, const Place& place) {
  if (!color.allFinite() || color.minCoeff() < 0)
    refuse("{}: ({}, {}, {}) is not a colour", place.text(), color.x(), color.y(), color.z());
}

void require_pose(const Pose& pose, const Place& place) {
  const Eigen::Matrix3d& R = pose.rotation;
  const bool is_rotation =
      R.allFinite() && (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-6 && R.determinant() > 0;
  if (!pose.position.allFinite() || !is_rotation)
    refuse("{}: the pose is not a finite position and a rotation", place.text());
  require_near(pose.position, place);
}

// The index of a label limits this number.
constexpr std::size_t most_parts = 4096;

void require_few(std::size_t count, const char* what) {
  if (count > most_parts) refuse("{} {}: expected at most {}", count, what, most_parts);
}

void check_arm(const ArmLook& arm) {
  require_color(arm.albedo, {"arm"});
  require_color(arm.disk_albedo, {"arm's disks"});
  require_few(arm.markers.size(), "markers");
  require_few(arm.disks.size(), "disks");
  for (std::size_t i = 0; i < arm.tube.size(); ++i) {
    const Arc& at = arm.tube[i];
    const auto place = [i](const char* value = nullptr) { return Place{"the arm's arc", value, i}; };
    require_pose(at.X_WS, place());
    require_size(at.length, place("length"));
    for (const double radius : at.radius) require_size(radius, place("radius"));
    require_finite(at.s, place("s"));
    for (const double bend : at.bend) require_finite(bend, place("bend"));
    require_finite(at.twist, place("twist"));
    if (!(at.bend.norm() <= largest_bend)) refuse("{}: a bend of {} rad", place().text(), at.bend.norm());
    if (at.section >= most_parts) refuse("{}: section {}", place().text(), at.section);
    if (i == 0) continue;
    const Arc& before = arm.tube[i - 1];
    const Pose X_WS = before.pose(before.length);
    const double off = (X_WS.position - at.X_WS.position).norm();
    const double turned = (X_WS.rotation.col(2) - at.X_WS.rotation.col(2)).norm();
    const bool continues = off <= 1e-6 * (1 + before.length) && turned <= 1e-6;
    if (!continues) refuse("{} does not continue the previous one", place().text());
  }
  for (const MarkerRing& marker : arm.markers) {
    require_color(marker.albedo, {"marker"});
    require_finite(marker.s_from, {"marker", "s"});
    require_finite(marker.s_to, {"marker", "s"});
    if (!(marker.s_from < marker.s_to))
      refuse("a marker from {} to {} has no width", marker.s_from, marker.s_to);
  }
  for (const GuideDisk& disk : arm.disks) {
    require_finite(disk.s, {"disk", "s"});
    require_size(disk.radius, {"disk", "radius"});
    require_size(disk.thickness, {"disk", "thickness"});
  }
}

void check_screen(const Screen& screen) {
  require_pose(screen.X_WS, {"screen"});
  require_color(screen.brightness, {"screen"});
  for (const double size : screen.size) require_size(size, {"screen", "size"});
  for (const double gradient : screen.gradient) require_finite(gradient, {"screen", "gradient"});
  require_finite(screen.falloff, {"screen", "falloff"});
}

void check_etalon(const Etalon& etalon) {
  require_pose(etalon.X_WE, {"etalon"});
  require_size(etalon.radius, {"etalon", "radius"});
  require_size(etalon.height, {"etalon", "height"});
  require_color(etalon.albedo, {"etalon"});
  require_color(etalon.line_albedo, {"etalon's lines"});
  const bool has_room_for_lines = etalon.line_width >= 0 && etalon.line_width < 1.5 * etalon.radius;
  if (!has_room_for_lines)
    refuse("etalon: lines of width {} do not fit around a cylinder of radius {}", etalon.line_width,
           etalon.radius);
}

struct ObstacleChecker {
  static void require_vector(const std::array<double, 3>& vector, const Place& place) {
    for (const double component : vector) require_finite(component, place);
  }
  static void require_place(const std::array<double, 3>& place, const Place& what) {
    require_near({place[0], place[1], place[2]}, what);
  }
  void operator()(const PlaneConfig& plane) const {
    require_place(plane.point, {"plane", "point"});
    require_vector(plane.normal, {"plane", "normal"});
    require_positive(std::hypot(plane.normal[0], plane.normal[1], plane.normal[2]),
                     {"plane", "normal's length"});
  }
  void operator()(const SphereConfig& sphere) const {
    require_place(sphere.center, {"sphere", "center"});
    require_size(sphere.radius, {"sphere", "radius"});
  }
  void operator()(const CapsuleConfig& capsule) const {
    require_place(capsule.from, {"capsule", "from"});
    require_place(capsule.to, {"capsule", "to"});
    require_size(capsule.radius, {"capsule", "radius"});
  }
  void operator()(const BoxConfig& box) const {
    require_place(box.center, {"box", "center"});
    for (const double half_size : box.half_sizes) require_size(half_size, {"box", "half_sizes"});
    double square = 0;
    for (const double component : box.rotation) square += component * component;
    require_positive(square, {"box", "rotation"});
  }
};

void check_light(const Light& light) {
  if (!light.direction.allFinite()) refuse("the light's direction is not finite");
  require_positive(light.direction.norm(), {"light", "direction's length"});
  require_finite(light.ambient + light.directional, {"light", "ambient and directional"});
  if (light.ambient < 0 || light.directional < 0)
    refuse("light: ambient {}, directional {}", light.ambient, light.directional);
  require_finite(light.shadow, {"light", "shadow"});
  if (light.shadow < 0 || light.shadow > 1) refuse("light: shadow {}", light.shadow);
  require_positive(light.angular_radius, {"light", "angular_radius"});
}

}  // namespace

void check(const Scene& scene) {
  check_arm(scene.arm);
  require_few(scene.screens.size(), "screens");
  for (const Screen& screen : scene.screens) check_screen(screen);
  if (scene.etalon) check_etalon(*scene.etalon);
  require_few(scene.obstacles.size(), "obstacles");
  for (const VisibleObstacle& obstacle : scene.obstacles) {
    require_color(obstacle.albedo, {"obstacle"});
    std::visit(ObstacleChecker{}, obstacle.shape);
  }
  check_light(scene.light);
  require_color(scene.background, {"background"});
}

void check_camera(const Pose& X_WC) { require_pose(X_WC, {"camera"}); }

}  // namespace flexura
