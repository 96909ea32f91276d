#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "flexura/render/prepared_scene.h"
#include "flexura/render/renderer.h"
#include "flexura/render/tracer.h"
#include "tests/support/frustums.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

/// Returns whether the line from a point in W in a direction is blocked.
using Blocker = std::function<bool(const Eigen::Vector3d& p_WQ, const Eigen::Vector3d& direction)>;

// Share of the round light's directions that reach p_WQ.
double sampled_share(const Light& light, const Eigen::Vector3d& p_WQ, const Blocker& is_blocked,
                     int samples) {
  const Eigen::Vector3d z = light.direction.normalized(), x = z.unitOrthogonal(), y = z.cross(x);
  int open = 0, all = 0;
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      const double a = 2 * (i + 0.5) / samples - 1, b = 2 * (j + 0.5) / samples - 1;
      if (a * a + b * b > 1) continue;
      ++all;
      if (!is_blocked(p_WQ, z + light.angular_radius * (a * x + b * y))) ++open;
    }
  }
  return static_cast<double>(open) / all;
}

// Whether the line meets the cylinder around the z of X_WS from its origin on.
bool meets_cylinder(const Pose& X_WS, double length, double radius, const Eigen::Vector3d& p_WQ,
                    const Eigen::Vector3d& direction) {
  const Eigen::Vector3d p = X_WS.inverse() * p_WQ, d = X_WS.rotation.transpose() * direction;
  double from = -p.z() / d.z(), to = (length - p.z()) / d.z();
  if (from > to) std::swap(from, to);
  const double A = d.head<2>().squaredNorm(), B = p.head<2>().dot(d.head<2>()),
               C = p.head<2>().squaredNorm() - radius * radius, root = B * B - A * C;
  if (!(root > 0)) return false;
  from = std::max({from, (-B - std::sqrt(root)) / A, 0.0}), to = std::min(to, (-B + std::sqrt(root)) / A);
  return from < to;
}

// Whether the line meets a convex body given by its distance function.
bool meets_body(const Obstacle& body, const Eigen::Vector3d& p_WQ, const Eigen::Vector3d& direction) {
  double low = 0, high = 3;
  for (int step = 0; step < 40; ++step) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    const bool is_before_b = body.distance(p_WQ + a * direction) < body.distance(p_WQ + b * direction);
    (is_before_b ? high : low) = is_before_b ? b : a;
  }
  return body.distance(p_WQ + low * direction) < 0;
}

// Compares a screen's light with the share of the light's directions that reach it. The screen lies on y = 0
// and is seen from below: all bodies on it are on its other side.
void expect_shadow(Scene scene, const Blocker& is_blocked) {
  Screen& floor = scene.screens.emplace_back();
  floor.X_WS.rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  floor.brightness = {1, 1, 1};
  scene.light.shadow = 0.8;
  scene.light.direction = {0.2, 1, 0.3};
  const View view = pinhole_view(look_at({0, -1, 0}, {0, 0, 0}, {0, 0, 1}), 44, 44, 60);
  Renderer renderer;
  LightImage picture;
  renderer.render(scene, view, PixelKind::gray, picture);
  double found = 0, expected = 0, squares = 0;
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const Eigen::Vector3d p_WQ =
          view.X_WC * Eigen::Vector3d(picture.depth.at(u, v) * ray_at(view.lens, {u, v})->direction);
      const double taken = 0.8 * (1 - sampled_share(scene.light, p_WQ, is_blocked, 15));
      found += 1 - picture.light.at(u, v), expected += taken;
      squares += std::pow(1 - picture.light.at(u, v) - taken, 2);
    }
  }
  EXPECT_GT(expected, 10);
  EXPECT_NEAR(found, expected, 0.03 * expected);
  // Near corners the light is not cut by a single straight edge.
  EXPECT_LT(std::sqrt(squares / (view.width * view.height)), 0.03);
}

void expect_shadow_of(const ObstacleConfig& shape) {
  Scene scene = plain_scene();
  scene.obstacles.push_back({shape});
  const Obstacle body = obstacles({shape}).front();
  expect_shadow(scene,
                [&](const Eigen::Vector3d& p, const Eigen::Vector3d& d) { return meets_body(body, p, d); });
}

TEST(Shadow, OfABallIsThatOfARoundLight) {
  expect_shadow_of(SphereConfig{.center = {0, 0.5, 0}, .radius = 0.12});
}

TEST(Shadow, OfARodIsThatOfARoundLight) {
  expect_shadow_of(CapsuleConfig{.from = {-0.2, 0.4, 0}, .to = {0.1, 0.5, 0.1}, .radius = 0.05});
}

TEST(Shadow, OfABoxIsThatOfARoundLight) {
  expect_shadow_of(
      BoxConfig{.center = {0, 0.4, 0}, .half_sizes = {0.15, 0.08, 0.1}, .rotation = {0.8, 0.36, 0.48, 0}});
}

TEST(Shadow, OfABoxOnTheFloorBeginsAtTheBox) {
  expect_shadow_of(BoxConfig{.center = {0, 0.1, 0}, .half_sizes = {0.1, 0.1, 0.1}});
}

TEST(Shadow, OfTheEtalonIsThatOfARoundLight) {
  for_random_cases(3, [](TestRandom& random) {
    Scene scene = plain_scene();
    Etalon& etalon = scene.etalon.emplace();
    etalon.X_WE = {so3_exp(random.vector<3>(-2, 2)), {0, 0.5, 0}};
    Pose X_WS;
    X_WS.rotation << etalon.X_WE.rotation.col(2), etalon.X_WE.rotation.col(0), etalon.X_WE.rotation.col(1);
    X_WS.position = etalon.X_WE * Eigen::Vector3d(0, -0.15, 0);
    expect_shadow(scene, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
      return meets_cylinder(X_WS, 0.3, 0.05, p, d);
    });
  });
}

TEST(Shadow, OfADiskReachesBeyondThatOfItsArm) {
  Arm arm;
  arm.X_WB.position = {0, 0.3, 0};
  arm.sections.push_back({.length = 0.4, .radius = {0.02, 0.02}});
  Scene scene = plain_scene();
  const Backbone backbone(arm, ArmState::straight(1));
  scene.arm.tube = tube_of(backbone);
  scene.arm.disks.push_back({.s = 0.2, .radius = 0.1, .thickness = 0.01});
  Pose at_disk = backbone.pose(0.195);
  expect_shadow(scene, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
    return meets_cylinder(backbone.pose(0), 0.4, 0.02, p, d) || meets_cylinder(at_disk, 0.01, 0.1, p, d);
  });
}

TEST(Shadow, OfAnArmThatStandsJustOverTheFloor) {
  Arm arm;
  arm.X_WB.position = {0, 0.02, 0};
  arm.sections.push_back({.length = 0.4, .radius = {0.08, 0.08}});
  Scene scene = plain_scene();
  const Backbone backbone(arm, ArmState::straight(1));
  scene.arm.tube = tube_of(backbone);
  expect_shadow(scene, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
    return meets_cylinder(backbone.pose(0), 0.4, 0.08, p, d);
  });
}

// An arched arm whose end shades its base.
TEST(Shadow, OfTheArmFallsOnItself) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (int i = 0; i < 2; ++i) arm.sections.push_back({.length = 0.5, .radius = {0.04, 0.03}});
  arm.sections[1].radius = {0.03, 0.02};
  ArmState state = ArmState::straight(2);
  state.bends = {{1.3, 0}, {1.6, 0}};
  const Backbone backbone(arm, state);
  const FrustumTube tube(arm, backbone, 60);
  Scene scene = plain_scene();
  scene.light = {
      .direction = {1, 0.05, 0.02}, .ambient = 0, .directional = 1, .shadow = 1, .angular_radius = 0.02};
  scene.arm.albedo = {1, 1, 1};
  scene.arm.tube = tube_of(backbone);
  const View view = pinhole_view(look_at({1, 1.1, 1}, {0.15, 0.25, 0}), 120, 120, 260);
  Renderer renderer;
  renderer.prepare(scene, view);
  const Tracer tracer(renderer.prepared().stage, renderer.prepared().tiles.all_parts());
  double squares = 0;
  int count = 0, shaded = 0, lit = 0;
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const Ray ray = *ray_at(view.lens, {u, v});
      const Hit hit = tracer.hit(ray);
      if (hit.is_none()) continue;
      const double cosine = hit.normal.dot(renderer.prepared().stage.light);
      const double share = gray_of(light_of(renderer.prepared().stage, hit, ray)) / std::max(cosine, 1e-9);
      if (cosine < 0.15) continue;
      const Eigen::Vector3d p_WQ = view.X_WC * Eigen::Vector3d(hit.depth * ray.direction + 1e-4 * hit.normal);
      const double expected = sampled_share(
          scene.light, p_WQ,
          [&](const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
            return FrustumTube::meet(tube.frustums(), p, d).s >= 0;
          },
          9);
      squares += std::pow(share - expected, 2);
      ++count;
      if (expected < 0.5) ++shaded;
      if (expected == 1) ++lit;
    }
  }
  EXPECT_GT(shaded, 10);
  EXPECT_GT(lit, 100);
  EXPECT_LT(std::sqrt(squares / count), 0.08);
}

}  // namespace
}  // namespace flexura
