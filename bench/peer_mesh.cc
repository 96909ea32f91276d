#include "bench/peer_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace flexura {
namespace {

constexpr int sides = 24;
constexpr double rows_per_metre = 100;

class MeshMaker {
 public:
  explicit MeshMaker(const Setting& setting) : setting_(setting), X_CW_(setting.view.X_WC.inverse()) {}

  void add_strip(const Strip& strip) {
    const double length = strip.s_to - strip.s_from;
    const int rows = std::max(1, static_cast<int>(std::lround(length * rows_per_metre)));
    for (int row = 0; row <= rows; ++row) {
      const std::uint32_t first = add_circle(strip.s_from + length * row / rows, strip.albedo, 0);
      for (std::uint32_t side = 0; row > 0 && side < sides; ++side) {
        const std::uint32_t a = first - sides + side, b = first - sides + (side + 1) % sides;
        add_triangle(a, b, a + sides);
        add_triangle(b, b + sides, a + sides);
      }
    }
  }

  // Adds the arm's flat end at s; `way` is 1 at the tip and -1 at the base.
  void add_end(double s, const Color& albedo, int way) {
    const Pose X_CS = X_CW_ * pose_at(setting_.scene.arm, s);
    const std::uint32_t first = add_circle(s, albedo, way);
    const std::uint32_t middle = add_corner(X_CS.position, way * X_CS.rotation.col(2), albedo);
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = first + side, b = first + (side + 1) % sides;
      add_triangle(middle, way > 0 ? a : b, way > 0 ? b : a);
    }
  }

  void add_screen(const Screen& screen) {
    const Pose X_CS = X_CW_ * screen.X_WS;
    const Color albedo = screen.brightness / setting_.scene.light.ambient;
    const auto first = static_cast<std::uint32_t>(mesh_.corners.size());
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      add_corner(X_CS * Eigen::Vector3d(x * screen.size[0], y * screen.size[1], 0), {0, 0, 0}, albedo);
    add_triangle(first, first + 1, first + 2);
    add_triangle(first, first + 2, first + 3);
  }

  [[nodiscard]] const PeerMesh& mesh() const { return mesh_; }

 private:
  // Adds a ring of corners around the arm at s. Their normals point outwards, or along the backbone if `way`
  // is not 0.
  std::uint32_t add_circle(double s, const Color& albedo, int way) {
    const Pose X_CS = X_CW_ * pose_at(setting_.scene.arm, s);
    const auto first = static_cast<std::uint32_t>(mesh_.corners.size());
    for (int side = 0; side < sides; ++side) {
      const double angle = 2 * std::numbers::pi * side / sides;
      const Eigen::Vector3d out = X_CS.rotation * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
      const Eigen::Vector3d along = way * X_CS.rotation.col(2);
      add_corner(X_CS.position + radius_of(setting_.scene.arm) * out, way == 0 ? out : along, albedo);
    }
    return first;
  }

  std::uint32_t add_corner(const Eigen::Vector3d& p_CP, const Eigen::Vector3d& normal, const Color& albedo) {
    mesh_.corners.push_back({p_CP.cast<float>(), normal.cast<float>(), albedo.cast<float>()});
    return static_cast<std::uint32_t>(mesh_.corners.size() - 1);
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.triangles.insert(mesh_.triangles.end(), {a, b, c});
  }

  const Setting& setting_;
  Pose X_CW_;
  PeerMesh mesh_;
};

}  // namespace

std::vector<Strip> strips_of(const ArmLook& arm) {
  std::vector<Strip> strips;
  double s = 0;
  for (const MarkerRing& ring : arm.markers) {
    strips.push_back({s, ring.s_from, arm.albedo});
    strips.push_back({ring.s_from, ring.s_to, ring.albedo});
    s = ring.s_to;
  }
  strips.push_back({s, length_of(arm), arm.albedo});
  return strips;
}

Pose pose_at(const ArmLook& arm, double s) {
  std::size_t i = 0;
  while (i + 1 < arm.tube.size() && s > arm.tube[i + 1].s) ++i;
  return arm.tube[i].pose(s - arm.tube[i].s);
}

double radius_of(const ArmLook& arm) { return arm.tube.front().radius[0]; }

double length_of(const ArmLook& arm) { return arm.tube.back().s + arm.tube.back().length; }

PeerMesh mesh_of(const Setting& setting) {
  const ArmLook& arm = setting.scene.arm;
  MeshMaker maker(setting);
  if (!arm.tube.empty()) {
    maker.add_end(0, arm.albedo, -1);
    for (const Strip& strip : strips_of(arm)) maker.add_strip(strip);
    maker.add_end(length_of(arm), arm.albedo, 1);
  }
  for (const Screen& screen : setting.scene.screens) maker.add_screen(screen);
  return maker.mesh();
}

Eigen::Vector3f light_in_camera(const Setting& setting) {
  return (setting.view.X_WC.rotation.transpose() * setting.scene.light.direction.normalized()).cast<float>();
}

}  // namespace flexura
