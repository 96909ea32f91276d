#include "flexura/app/gltf_shapes.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace flexura {
namespace {

constexpr std::uint32_t around = 24;  // Vertices of a circle; the first one is there twice.
constexpr int half_ball_rings = 6;

Eigen::Vector3d on_circle(std::uint32_t i) {
  const double angle = 2 * std::numbers::pi * (i % around) / around;
  return {std::cos(angle), std::sin(angle), 0};
}

void add_vertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, GltfMesh& mesh) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal.normalized());
}

// Adds the triangles between the circles of vertices that begin at `first`, one after another along z.
void add_bands(std::uint32_t first, std::uint32_t circles, GltfMesh& mesh) {
  const std::uint32_t row = around + 1;
  for (std::uint32_t c = 0; c + 1 < circles; ++c) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t at = first + c * row + i;
      mesh.triangles.insert(mesh.triangles.end(), {at, at + 1, at + row + 1, at, at + row + 1, at + row});
    }
  }
}

// Half the profile of a body of revolution about z: radius, height and the normal's parts along them.
struct ProfilePoint {
  double radius, z, normal_radius, normal_z;
};

// Adds the surface of revolution of a profile that goes upwards.
void add_revolved(const Pose& pose, std::span<const ProfilePoint> profile, GltfMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const ProfilePoint& p : profile) {
    for (std::uint32_t i = 0; i <= around; ++i) {
      const Eigen::Vector3d out = on_circle(i);
      add_vertex(pose * (p.radius * out + p.z * Eigen::Vector3d::UnitZ()),
                 pose.rotation * (p.normal_radius * out + p.normal_z * Eigen::Vector3d::UnitZ()), mesh);
    }
  }
  add_bands(first, static_cast<std::uint32_t>(profile.size()), mesh);
}

// Points of a quarter circle from `from` to `to`, rad above the equator, about height z.
void add_quarter(double radius, double z, double from, double to, std::vector<ProfilePoint>& profile) {
  for (int i = 0; i <= half_ball_rings; ++i) {
    const double angle = from + (to - from) * i / half_ball_rings;
    // The pole's circle is so small that its triangles are still ones.
    const double across = std::max(std::cos(angle), 1e-4), up = std::sin(angle);
    profile.push_back({radius * across, z + radius * up, across, up});
  }
}

}  // namespace

GltfMesh tube_mesh(std::span<const TubeRing> rings) {
  GltfMesh mesh;
  for (const TubeRing& ring : rings) {
    for (std::uint32_t i = 0; i <= around; ++i) {
      const Eigen::Vector3d out = on_circle(i);
      add_vertex(ring.pose * (ring.radius * out), ring.pose.rotation * out, mesh);
      mesh.joints.push_back(ring.joint);
    }
  }
  add_bands(0, static_cast<std::uint32_t>(rings.size()), mesh);
  return mesh;
}

void add_lid(const TubeRing& ring, TipKind kind, double side, GltfMesh& mesh) {
  constexpr double quarter = std::numbers::pi / 2;
  std::vector<ProfilePoint> profile;
  if (kind == TipKind::round) {
    add_quarter(ring.radius, 0, side > 0 ? 0 : -quarter, side > 0 ? quarter : 0, profile);
  } else {
    const ProfilePoint edge{ring.radius, 0, 0, side}, middle{1e-4 * ring.radius, 0, 0, side};
    profile = {edge, middle};
    if (side < 0) std::swap(profile[0], profile[1]);
  }
  add_revolved(ring.pose, profile, mesh);
  mesh.joints.resize(mesh.positions.size(), ring.joint);
}

GltfMesh ball_mesh(double radius) { return capsule_mesh(radius, 0); }

GltfMesh capsule_mesh(double radius, double length) {
  constexpr double quarter = std::numbers::pi / 2;
  std::vector<ProfilePoint> profile;
  add_quarter(radius, -length / 2, -quarter, 0, profile);
  if (length == 0) profile.pop_back();
  add_quarter(radius, length / 2, 0, quarter, profile);
  GltfMesh mesh;
  add_revolved({}, profile, mesh);
  return mesh;
}

GltfMesh box_mesh(const Eigen::Vector3d& half_sizes) {
  GltfMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d u = Eigen::Vector3d::Unit((axis + 1) % 3), v = normal.cross(u);
      for (const auto& [a, b] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
        add_vertex((normal + a * u + b * v).cwiseProduct(half_sizes), normal, mesh);
      mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
  }
  return mesh;
}

GltfMesh square_mesh(double half) {
  GltfMesh mesh;
  for (const auto& [x, y] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
    add_vertex({half * x, half * y, 0}, Eigen::Vector3d::UnitZ(), mesh);
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  return mesh;
}

}  // namespace flexura
