// Area-weighted light of border pixels. Arms are compared with thousands of frustums. Guide disks, the etalon
// and obstacles, cut by each other and by the arm, are compared with implicit bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "flexura/render/cell.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/renderer.h"
#include "flexura/render/tracer.h"
#include "tests/support/coverage_errors.h"
#include "tests/support/frustums.h"
#include "tests/support/implicit_bodies.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// A scene in two forms: as it is drawn, and as its bodies, each with its gray level on all sides.
struct KnownScene {
  struct Body {
    ImplicitBody body;
    double gray;
  };
  Scene scene = plain_scene();
  std::vector<Body> bodies;
  std::optional<FrustumTube> arm;
  std::function<double(double)> arm_gray = [](double /*s*/) { return 1.0; };

  void set_arm(const BentArm& bent, const Backbone& backbone) {
    constexpr int frustums = 300;  // Per section.
    arm.emplace(bent.arm, backbone, frustums);
    scene.arm.tube = tube_of(backbone);
    scene.arm.albedo = Color::Constant(arm_gray(-1));
  }

  void add(const ObstacleConfig& obstacle, double gray) {
    scene.obstacles.push_back({obstacle, Color::Constant(gray)});
    for (const ImplicitBody& body : implicit_bodies(obstacle)) bodies.push_back({body, gray});
  }
  // Gray level seen from `eye` in a direction near which the arm has only these frustums.
  [[nodiscard]] double gray(const std::vector<FrustumTube::Frustum>& near, const Eigen::Vector3d& eye,
                            const Eigen::Vector3d& direction) const {
    double depth = ImplicitBody::nowhere, result = 0;
    for (const Body& body : bodies) {
      const double entry = body.body.entry(eye, direction);
      if (entry < depth) depth = entry, result = body.gray;
    }
    if (scene.etalon) {
      const double entry = implicit_etalon(*scene.etalon).entry(eye, direction);
      const bool is_line = entry < depth && is_on_etalon_line(*scene.etalon, eye + entry * direction);
      if (entry < depth) result = gray_of(is_line ? scene.etalon->line_albedo : scene.etalon->albedo);
      depth = std::min(depth, entry);
    }
    if (near.empty()) return result;
    const auto meeting = FrustumTube::meet(near, eye, direction);
    return meeting.depth < depth ? arm_gray(meeting.s) : result;
  }
};

double mean_gray(const KnownScene& known, const std::vector<FrustumTube::Frustum>& near, const View& view,
                 int u, int v, int samples) {
  double sum = 0;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const auto ray = ray_at(view.lens, {u - 0.5 + (i + 0.5) / samples, v - 0.5 + (j + 0.5) / samples});
      if (ray) sum += known.gray(near, view.X_WC.position, view.X_WC.rotation * ray->direction);
    }
  }
  return sum / (samples * samples);
}

void compare_known(const KnownScene& known, const View& view, BothCoverageErrors& errors) {
  Renderer renderer;
  LightImage exact, quick;
  renderer.render(known.scene, view, PixelKind::gray, exact, true);
  renderer.render(known.scene, view, PixelKind::gray, quick);
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const auto ray = renderer.prepared().rays.ray(u, v);
      if (!ray) continue;
      const auto near = known.arm ? known.arm->near(view.X_WC.position, view.X_WC.rotation * ray->direction,
                                                    renderer.prepared().rays.largest_step())
                                  : std::vector<FrustumTube::Frustum>();
      const double in_exact = exact.light.at(u, v), in_quick = quick.light.at(u, v);
      const double rough = mean_gray(known, near, view, u, v, 5);
      if (std::abs(in_exact - rough) < 1e-4 && std::abs(in_quick - rough) < 1e-4) continue;
      const double expected = mean_gray(known, near, view, u, v, 64);
      errors.exact.add(in_exact - expected);
      errors.quick.add(in_quick - expected);
    }
  }
}

// The arm alone, in white.
void compare_silhouettes(const BentArm& bent, const Backbone& backbone, const View& view,
                         BothCoverageErrors& errors) {
  KnownScene known;
  known.set_arm(bent, backbone);
  compare_known(known, view, errors);
}
void compare_silhouettes(TestRandom& random, double taper, BothCoverageErrors& errors) {
  const BentArm bent = random_bent_arm(random, taper);
  const Backbone backbone = bent.backbone();
  compare_silhouettes(bent, backbone, random_view_of(random, backbone), errors);
}

// Aimed at a point of the backbone, with another focal length.
View aimed(const View& view, const Backbone& backbone, double s, double focal_length) {
  return pinhole_view(look_at(view.X_WC.position, backbone.pose(s).position), view.width, view.height,
                      focal_length);
}

TEST(Coverage, OfTubesIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) { compare_silhouettes(random, 0, errors); });
  errors.expect_small();
}

TEST(Coverage, OfTaperedTubesIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) { compare_silhouettes(random, 0.006, errors); });
  errors.expect_small();
}

// The narrower side of a step in white, the rest in black.
TEST(Coverage, OfTubesWhoseRadiusStepsIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0, 0.006);
    const Backbone backbone = bent.backbone();
    const double step = backbone.arcs()[1].s;
    const bool is_after = bent.arm.sections[1].radius[0] < bent.arm.sections[0].radius[1];
    const double from = is_after ? step : step - 0.1, to = is_after ? step + 0.1 : step;
    KnownScene known;
    known.arm_gray = [=](double s) { return s > from && s < to ? 1.0 : 0.0; };
    known.set_arm(bent, backbone);
    known.scene.arm.markers.push_back({from, to, {1, 1, 1}});
    compare_known(known, aimed(random_view_of(random, backbone), backbone, step, random.uniform(400, 1500)),
                  errors);
  });
  errors.expect_small();
}

// Half of the arms are tapered.
double taper_or_none(TestRandom& random, double taper) { return random.integer(0, 1) == 0 ? taper : 0; }

// The arm in black with white rings.
void compare_rings(const BentArm& bent, const Backbone& backbone, const View& view, double pitch,
                   BothCoverageErrors& errors) {
  KnownScene known;
  auto& rings = known.scene.arm.markers;
  for (double s = 0.5 * pitch; s < 0.9; s += pitch) rings.push_back({s, s + 0.3 * pitch, {1, 1, 1}});
  const auto count = static_cast<double>(rings.size());
  known.arm_gray = [=](double s) {
    const double turns = s / pitch - 0.5;
    return turns >= 0 && turns - std::floor(turns) < 0.3 && turns < count ? 1.0 : 0.0;
  };
  known.set_arm(bent, backbone);
  compare_known(known, view, errors);
}

TEST(Coverage, OfMarkerRingsIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, taper_or_none(random, 0.004));
    const Backbone backbone = bent.backbone();
    compare_rings(bent, backbone, random_view_of(random, backbone), 0.1, errors);
  });
  errors.expect_small();
}

TEST(Coverage, OfRingsFinerThanPixelsIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(1, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, taper_or_none(random, 0.004));
    const Backbone backbone = bent.backbone();
    const double pitch = random.uniform(0.0004, 0.01);
    compare_rings(bent, backbone, random_view_of(random, backbone), pitch, errors);
  });
  errors.expect_small();
}

// From a tube of 2 px to one that fills the picture, with lenses of all kinds.
TEST(Coverage, AtAnyZoomIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(2, [&](TestRandom& random) {
    BentArm bent = random_bent_arm(random, taper_or_none(random, 0.003), taper_or_none(random, 0.003));
    const double thickness = std::exp(random.uniform(-1.5, 0.7));
    for (Section& section : bent.arm.sections) {
      for (double& radius : section.radius) radius *= thickness;
    }
    const Backbone backbone = bent.backbone();
    View view = aimed(random_view_of(random, backbone), backbone, random.uniform(0, backbone.length()),
                      200 * std::exp(random.uniform(-1, 2)));
    Intrinsics lens = view.lens.intrinsics();
    // Equal distortion at the picture's edge for every focal length.
    const double wide = std::pow(lens.fx / 200, 2);
    if (random.integer(0, 1) == 0) lens.distortion = {random.uniform(-0.3, 0.3) * wide, 0, 0.001, -0.001, 0};
    view.lens = Lens(lens);
    compare_silhouettes(bent, backbone, view, errors);
    compare_rings(bent, backbone, view, 0.11, errors);  // No ring over a step.
  });
  errors.expect_small();
}

// Mean of samples x samples rays of a pixel.
double mean_of_rays(const Tracer& tracer, const Ray& pixel, int samples) {
  double sum = 0;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const Ray ray = moved(pixel, {(i + 0.5) / samples - 0.5, (j + 0.5) / samples - 0.5});
      sum += gray_of(light_of(tracer.stage(), tracer.hit(ray), ray));
    }
  }
  return sum / (samples * samples);
}

// Errors of the reference path's picture against samples of the same surfaces.
void compare_with_rays(const Scene& scene, const View& view, CoverageErrors& errors) {
  Renderer renderer;
  LightImage picture;
  renderer.render(scene, view, PixelKind::gray, picture, true);
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const auto ray = renderer.prepared().rays.ray(u, v);
      if (!ray) continue;
      const Tracer tracer(renderer.prepared().stage,
                          renderer.prepared().tiles.parts(u / Tiles::size, v / Tiles::size));
      const double found = picture.light.at(u, v), rough = mean_of_rays(tracer, *ray, 4);
      if (std::abs(found - rough) > 1e-4) errors.add(found - mean_of_rays(tracer, *ray, 32));
    }
  }
}

// Bodies that hide each other everywhere.
TEST(Coverage, OfCrowdedScenesIsThatOfTheirRays) {
  CoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.003);
    const Backbone backbone = bent.backbone();
    View view = random_view_of(random, backbone);
    Intrinsics lens = view.lens.intrinsics();
    lens.distortion = {-0.2, 0.05, 0.001, 0.001, 0};
    view.lens = Lens(lens);
    compare_with_rays(crowded_scene(random, backbone), view, errors);
  });
  errors.expect_small("crowded");
}

// A camera that looks at the origin from 1 to 2 m; half of the lenses have distortion.
View view_of_origin(TestRandom& random) {
  const Eigen::Vector3d from = random.vector<3>(-1, 1).normalized() * random.uniform(1, 2);
  View view = pinhole_view(look_at(from, random.vector<3>(-0.1, 0.1), {0.1, 1, 0.05}), 96, 72,
                           random.uniform(80, 250));
  Intrinsics lens = view.lens.intrinsics();
  if (random.integer(0, 1) == 0) lens.distortion = {-0.2, 0.05, 0.001, 0.001, 0};
  if (random.integer(0, 3) == 0) lens.distortion = {0.05, 0.01, 0, 0};
  view.lens = Lens(lens);
  return view;
}

std::array<double, 3> near_origin(TestRandom& random) {
  const Eigen::Vector3d p = random.vector<3>(-0.25, 0.25);
  return {p.x(), p.y(), p.z()};
}

void add_obstacles(TestRandom& random, KnownScene& known) {
  known.add(SphereConfig{.center = near_origin(random), .radius = random.uniform(0.05, 0.2)}, 1);
  const auto from = near_origin(random);
  known.add(CapsuleConfig{.from = from, .to = near_origin(random), .radius = random.uniform(0.02, 0.1)}, 0.6);
  const Eigen::Vector4d turn = random.vector<4>(-1, 1);
  known.add(BoxConfig{.center = near_origin(random),
                      .half_sizes = {random.uniform(0.05, 0.2), 0.1, 0.05},
                      .rotation = {turn[0], turn[1], turn[2], turn[3]}},
            0.3);
}

TEST(BodyCoverage, OfObstaclesThatCutEachOtherIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(5, [&](TestRandom& random) {
    KnownScene known;
    add_obstacles(random, known);
    if (random.integer(0, 1) == 0) known.add(PlaneConfig{.point = {0, -0.2, 0}}, 0.8);
    compare_known(known, view_of_origin(random), errors);
  });
  errors.expect_small();
}

TEST(BodyCoverage, OfTheEtalonAmongObstaclesIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) {
    KnownScene known;
    Etalon& etalon = known.scene.etalon.emplace();
    const auto place = near_origin(random);
    etalon.X_WE = {so3_exp(random.vector<3>(-2, 2)), {place[0], place[1], place[2]}};
    etalon.radius = random.uniform(0.04, 0.15), etalon.height = random.uniform(0.2, 0.6);
    etalon.line_width = random.uniform(0.004, 0.03);
    etalon.albedo = Color::Constant(0.1), etalon.line_albedo = Color::Constant(1);
    if (random.integer(0, 1) == 0) add_obstacles(random, known);
    compare_known(known, view_of_origin(random), errors);
  });
  errors.expect_small();
}

// With `wildness` 1 the arm passes clear of all disks except the one it carries; with more it passes through
// them.
void compare_known_disks(TestRandom& random, double wildness, BothCoverageErrors& errors) {
  BentArm bent = random_bent_arm(random, 0, 0.008);
  for (Eigen::Vector2d& bend : bent.state.bends) bend *= wildness;
  const Backbone backbone = bent.backbone();
  KnownScene known;
  known.arm_gray = [](double /*s*/) { return 0.2; };
  known.set_arm(bent, backbone);
  known.scene.arm.disk_albedo = Color::Constant(1);
  const double step = backbone.arcs()[1].s;
  known.scene.arm.disks = {{step, 0.05, 0.01}, {step + random.uniform(-0.1, 0.1), 0.06, 0.004}};
  for (const GuideDisk& disk : known.scene.arm.disks)
    known.bodies.push_back({implicit_disk(backbone.pose(disk.s), disk), 1});
  const View around = random_view_of(random, backbone);
  const View view = pinhole_view(look_at(around.X_WC.position, backbone.pose(step).position), 96, 72,
                                 random.uniform(200, 500));
  compare_known(known, view, errors);
}

TEST(BodyCoverage, OfGuideDisksIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) { compare_known_disks(random, 1, errors); });
  errors.expect_small();
}

TEST(BodyCoverage, OfGuideDisksThatTheArmPassesThroughIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(3, [&](TestRandom& random) { compare_known_disks(random, 2.5, errors); });
  errors.expect_small();
}

}  // namespace
}  // namespace flexura
