#include "flexura/render/stage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "flexura/math/so3.h"
#include "flexura/render/shadow.h"

namespace flexura {
namespace {

int add_body(Stage& stage, SurfaceKind kind, std::size_t index, const Color& albedo) {
  Body body;
  body.label = {kind, static_cast<std::uint16_t>(index)};
  body.albedo = albedo;
  stage.bodies.push_back(body);
  return static_cast<int>(stage.bodies.size()) - 1;
}

// A straight tube, closed by discs, around the z of X_WS from its origin on.
Arc straight_tube(const Pose& X_WS, double length, double radius) {
  Arc tube;
  tube.X_WS = X_WS;
  tube.length = length;
  tube.radius = {radius, radius};
  return tube;
}

void add_ring_edge(std::span<const Arc> tube, double s, const Pose& X_CW, Stage& stage) {
  const Arc& at = tube_arc_at(tube, s);
  const double along = std::clamp(s - at.s, 0.0, at.length);
  const double radius = at.radius[0] + (at.radius[1] - at.radius[0]) * along / at.length;
  const Pose X_CS = X_CW * at.pose(along);
  stage.ring_edges.push_back({s, circle_at(X_CS.rotation, X_CS.position, radius)});
}

// Determines which marker is visible at each arc length: among overlapping markers, the last one in the list.
void add_rings(std::span<const MarkerRing> markers, Stage& stage) {
  for (std::size_t i = 0; i < markers.size(); ++i) {
    stage.rings.push_back({markers[i].s_from, static_cast<int>(i)});
    stage.rings.push_back({markers[i].s_to, -1});
  }
  std::ranges::sort(stage.rings, {}, &RingStretch::s);
  std::vector<int>& open = stage.open_rings;  // A heap with the last marker in front.
  open.clear();
  for (RingStretch& ring : stage.rings) {
    if (ring.marker >= 0) {
      open.push_back(ring.marker);
      std::ranges::push_heap(open);
    }
    while (!open.empty() && markers[static_cast<std::size_t>(open.front())].s_to <= ring.s) {
      std::ranges::pop_heap(open);
      open.pop_back();
    }
    ring.marker = open.empty() ? -1 : open.front();
  }
}

// Returns the arm piece whose side emerges from a face at arc length s, or the nearest one. It is towards the
// tip if `side` > 0, otherwise towards the base.
int arm_piece_at(const Stage& stage, double s, double side) {
  int result = stage.first_arm_piece;
  for (int i = stage.first_arm_piece; i <= stage.last_arm_piece; ++i) {
    const TubePiece& piece = stage.pieces[static_cast<std::size_t>(i)];
    if (!piece.is_ball && (side > 0 ? piece.s <= s : piece.s < s)) result = i;
  }
  return result;
}

void add_arm(const ArmLook& arm, const Pose& X_CW, Stage& stage) {
  if (arm.tube.empty()) return;
  const int skin = add_body(stage, SurfaceKind::section, 0, arm.albedo);
  stage.bodies.back().is_arm = true;
  const int base = add_body(stage, SurfaceKind::cap, 0, arm.albedo);
  const int tip = add_body(stage, SurfaceKind::cap, 1, arm.albedo);
  const int step = add_body(stage, SurfaceKind::cap, 2, arm.albedo);
  stage.first_arm_piece = static_cast<int>(stage.pieces.size());
  add_tube(arm.tube, X_CW, skin, step, {TubeEnd{TipKind::flat, base}, TubeEnd{arm.tip, tip}}, stage);
  stage.last_arm_piece = static_cast<int>(stage.pieces.size()) - 1;
  stage.arm_length = arm.tube.back().s + arm.tube.back().length;
  add_rings(arm.markers, stage);
  for (const MarkerRing& marker : arm.markers) {
    for (const double s : {marker.s_from, marker.s_to}) {
      if (s > arm.tube.front().s && s < stage.arm_length) add_ring_edge(arm.tube, s, X_CW, stage);
    }
  }
  for (std::size_t i = 0; i < arm.disks.size(); ++i) {
    const GuideDisk& disk = arm.disks[i];
    const Arc& at = tube_arc_at(arm.tube, disk.s);
    Pose X_WS = at.pose(std::clamp(disk.s - at.s, 0.0, at.length));
    X_WS.position -= 0.5 * disk.thickness * X_WS.rotation.col(2);
    const int body = add_body(stage, SurfaceKind::disk, i, arm.disk_albedo);
    const Arc tube = straight_tube(X_WS, disk.thickness, disk.radius);
    add_tube({&tube, 1}, X_CW, body, body, {TubeEnd{TipKind::flat, body}, TubeEnd{TipKind::flat, body}},
             stage);
    add_caster(tube, TipKind::flat, X_CW, stage);
    for (const double side : {-0.5, 0.5}) {
      DiscPart& face = stage.discs[stage.discs.size() - (side < 0 ? 2 : 1)];
      const double s = disk.s + side * disk.thickness;
      face.arm_piece = arm_piece_at(stage, s, side);
      stage.ring_edges.push_back({s, face.circle, true});
    }
  }
  std::ranges::sort(stage.ring_edges, {}, &RingEdge::s);
}

void add_face(const Pose& X_CS, double half_x, double half_y, int body, int screen, Stage& stage) {
  const auto corner = [&](double x, double y) { return X_CS * Eigen::Vector3d(x * half_x, y * half_y, 0); };
  stage.faces.push_back(
      {face_of({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}), body, screen});
}

void add_etalon(const Etalon& etalon, const Pose& X_CW, Stage& stage) {
  const int skin = add_body(stage, SurfaceKind::etalon, 0, etalon.albedo);
  stage.bodies.back().is_etalon = true;
  const int top = add_body(stage, SurfaceKind::etalon, 1, etalon.albedo);
  const int bottom = add_body(stage, SurfaceKind::etalon, 2, etalon.albedo);
  const Pose& X_WE = etalon.X_WE;
  Pose X_WS;  // z along the etalon's +Y, x along its +Z
  X_WS.rotation << X_WE.rotation.col(2), X_WE.rotation.col(0), X_WE.rotation.col(1);
  X_WS.position = X_WE.position - 0.5 * etalon.height * X_WE.rotation.col(1);
  const Arc tube = straight_tube(X_WS, etalon.height, etalon.radius);
  add_tube({&tube, 1}, X_CW, skin, skin, {TubeEnd{TipKind::flat, bottom}, TubeEnd{TipKind::flat, top}},
           stage);
  add_caster(tube, TipKind::flat, X_CW, stage);
  stage.X_CE = X_CW * X_WE;
  const double half_width = 0.5 * etalon.line_width / etalon.radius;
  if (!(half_width > 0)) return;
  for (int line = 0; line < 4; ++line) {
    for (const double side : {-1.0, 1.0}) {
      const double angle = line * std::numbers::pi / 2 + side * half_width;
      const Eigen::Vector3d foot(etalon.radius * std::sin(angle), 0.5 * etalon.height,
                                 etalon.radius * std::cos(angle));
      stage.line_edges.push_back({stage.X_CE * Eigen::Vector3d(foot.x(), -foot.y(), foot.z()),
                                  stage.X_CE * foot, std::remainder(angle, 2 * std::numbers::pi)});
    }
  }
}

struct ObstacleAdder {
  const Pose& X_CW;
  int body;
  Stage& stage;

  void operator()(const PlaneConfig& plane) const {
    const Eigen::Vector3d point = Eigen::Map<const Eigen::Vector3d>(plane.point.data());
    const Eigen::Vector3d normal = Eigen::Map<const Eigen::Vector3d>(plane.normal.data());
    stage.bodies[static_cast<std::size_t>(body)].takes_all_shadows = true;
    stage.planes.push_back({X_CW * point, X_CW.rotation * normal.normalized(), body});
  }
  void operator()(const SphereConfig& sphere) const {
    add_ball_tube(Eigen::Map<const Eigen::Vector3d>(sphere.center.data()),
                  Eigen::Map<const Eigen::Vector3d>(sphere.center.data()), sphere.radius);
  }
  void operator()(const CapsuleConfig& capsule) const {
    add_ball_tube(Eigen::Map<const Eigen::Vector3d>(capsule.from.data()),
                  Eigen::Map<const Eigen::Vector3d>(capsule.to.data()), capsule.radius);
  }
  void operator()(const BoxConfig& box) const {
    const auto& q = box.rotation;
    Pose X_CB = X_CW;
    X_CB.position = X_CW * Eigen::Map<const Eigen::Vector3d>(box.center.data());
    X_CB.rotation *= Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    add_caster(X_CB, box.half_sizes, stage);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const auto column = [&](std::size_t i) {
          return X_CB.rotation.col(static_cast<Eigen::Index>((axis + i) % 3));
        };
        Pose X_CF;
        X_CF.rotation << side * column(1), column(2), side * column(0);
        X_CF.position = X_CB.position + side * box.half_sizes[axis] * column(0);
        add_face(X_CF, box.half_sizes[(axis + 1) % 3], box.half_sizes[(axis + 2) % 3], body, -1, stage);
      }
    }
  }

 private:
  void add_ball_tube(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) const {
    const Eigen::Vector3d way = to - from;
    const double length = way.norm();
    Pose X_WS;
    X_WS.position = from;
    if (length > 0) X_WS.rotation = rotation_from_z(way);
    // A sphere is a capsule of almost zero length.
    const Arc tube = straight_tube(X_WS, std::max(length, 1e-9 * radius), radius);
    add_tube({&tube, 1}, X_CW, body, body, {TubeEnd{TipKind::round, body}, TubeEnd{TipKind::round, body}},
             stage);
    add_caster(tube, TipKind::round, X_CW, stage);
  }
};

}  // namespace

void build_stage(const Scene& scene, const Pose& X_WC, double pixel, Stage& stage) {
  const Pose X_CW = X_WC.inverse();
  stage.scene = &scene;
  stage.pixel = pixel;
  stage.light = X_CW.rotation * scene.light.direction.normalized();
  stage.first_arm_piece = 0, stage.last_arm_piece = -1;
  stage.arm_length = 0;
  stage.bodies.clear();
  stage.pieces.clear();
  stage.discs.clear();
  stage.faces.clear();
  stage.planes.clear();
  stage.ring_edges.clear();
  stage.rings.clear();
  stage.line_edges.clear();
  stage.casters.clear();
  stage.caster_sides.clear();
  add_arm(scene.arm, X_CW, stage);
  for (std::size_t i = 0; i < scene.screens.size(); ++i) {
    const Screen& screen = scene.screens[i];
    const int body = add_body(stage, SurfaceKind::screen, i, screen.brightness);
    stage.bodies.back().takes_all_shadows = true;
    add_face(X_CW * screen.X_WS, 0.5 * screen.size[0], 0.5 * screen.size[1], body, static_cast<int>(i),
             stage);
  }
  if (scene.etalon) add_etalon(*scene.etalon, X_CW, stage);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const int body = add_body(stage, SurfaceKind::obstacle, i, scene.obstacles[i].albedo);
    std::visit(ObstacleAdder{X_CW, body, stage}, scene.obstacles[i].shape);
  }
}

}  // namespace flexura
