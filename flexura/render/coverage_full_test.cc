#include <gtest/gtest.h>

#include <cmath>

#include "flexura/render/cell.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/renderer.h"
#include "flexura/render/tracer.h"
#include "tests/support/coverage_errors.h"
#include "tests/support/frustums.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// The share of `samples` x `samples` points of pixel (u, v) at which the tube shows an s that is_counted.
template <typename IsCounted>
double sampled(const std::vector<FrustumTube::Frustum>& frustums, const View& view, int u, int v, int samples,
               IsCounted&& is_counted) {
  int hits = 0;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const double x = u - 0.5 + (i + 0.5) / samples, y = v - 0.5 + (j + 0.5) / samples;
      const auto ray = ray_at(view.lens, {x, y});
      if (!ray) continue;
      const auto meeting =
          FrustumTube::meet(frustums, view.X_WC.position, view.X_WC.rotation * ray->direction);
      if (meeting.s >= 0 && is_counted(meeting.s)) ++hits;
    }
  }
  return static_cast<double>(hits) / (samples * samples);
}

// Draws `scene`, in which the tube shows 1 where its s is_counted and 0 elsewhere, both ways, and adds the
// errors of the border pixels.
template <typename IsCounted>
void compare(const Scene& scene, const FrustumTube& tube, const View& view, IsCounted&& is_counted,
             BothCoverageErrors& errors) {
  Renderer renderer;
  LightImage exact, quick;
  renderer.render(scene, view, PixelKind::gray, exact, true);
  renderer.render(scene, view, PixelKind::gray, quick);
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const auto ray = renderer.prepared().rays.ray(u, v);
      if (!ray) continue;
      const auto near = tube.near(view.X_WC.position, view.X_WC.rotation * ray->direction,
                                  renderer.prepared().rays.largest_step());
      const double in_exact = exact.light.at(u, v), in_quick = quick.light.at(u, v);
      const double rough = sampled(near, view, u, v, 5, is_counted);
      const bool is_inner = (rough == 0 || rough == 1) && std::abs(in_exact - rough) < 1e-6 &&
                            std::abs(in_quick - rough) < 1e-6;
      if (is_inner) continue;
      const double expected = sampled(near, view, u, v, 64, is_counted);
      errors.exact.add(in_exact - expected);
      errors.quick.add(in_quick - expected);
    }
  }
}

constexpr int frustums_a_section = 300;

// The arm in white alone.
void compare_silhouettes(const BentArm& bent, const Backbone& backbone, const View& view,
                         BothCoverageErrors& errors) {
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(bent.arm, backbone);
  scene.arm.albedo = {1, 1, 1};
  compare(
      scene, FrustumTube(bent.arm, backbone, frustums_a_section), view, [](double) { return true; }, errors);
}
void compare_silhouettes(TestRandom& random, double taper, BothCoverageErrors& errors) {
  const BentArm bent = random_bent_arm(random, taper);
  const Backbone backbone = bent.backbone();
  compare_silhouettes(bent, backbone, random_view_of(random, backbone), errors);
}

// Turned to a point of the backbone, and with another focal length.
View aimed(const View& view, const Backbone& backbone, double s, double focal_length) {
  return pinhole_view(look_at(view.X_WC.position, backbone.pose(s).position), view.width, view.height,
                      focal_length);
}

TEST(Coverage, OfTubesIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(6, [&](TestRandom& random) { compare_silhouettes(random, 0, errors); });
  errors.expect_small();
}

TEST(Coverage, OfTaperedTubesIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(6, [&](TestRandom& random) { compare_silhouettes(random, 0.006, errors); });
  errors.expect_small();
}

// The narrower side of a step in white, the rest in black.
TEST(Coverage, OfTubesWhoseRadiusStepsIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(10, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0, 0.006);
    const Backbone backbone = bent.backbone();
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(bent.arm, backbone);
    scene.arm.albedo = Color::Zero();
    const double step = backbone.arcs()[1].s;
    const bool is_after = bent.arm.sections[1].radius[0] < bent.arm.sections[0].radius[1];
    const double from = is_after ? step : step - 0.1, to = is_after ? step + 0.1 : step;
    scene.arm.markers.push_back({from, to, {1, 1, 1}});
    const View view = aimed(random_view_of(random, backbone), backbone, step, random.uniform(400, 1500));
    compare(
        scene, FrustumTube(bent.arm, backbone, frustums_a_section), view,
        [&](double s) { return s > from && s < to; }, errors);
  });
  errors.expect_small();
}

// Arms with taper and without.
double taper_or_none(TestRandom& random, double taper) { return random.integer(0, 1) == 0 ? taper : 0; }

// The arm in black, with rings in white.
void compare_rings(const BentArm& bent, const Backbone& backbone, const View& view, double pitch,
                   BothCoverageErrors& errors) {
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(bent.arm, backbone);
  scene.arm.albedo = Color::Zero();
  const double length = 0.9;
  for (double s = 0.5 * pitch; s < length; s += pitch)
    scene.arm.markers.push_back({s, s + 0.3 * pitch, {1, 1, 1}});
  const auto is_marked = [&](double s) {
    const double turns = s / pitch - 0.5;
    return turns >= 0 && turns - std::floor(turns) < 0.3 &&
           turns < static_cast<double>(scene.arm.markers.size());
  };
  compare(scene, FrustumTube(bent.arm, backbone, frustums_a_section), view, is_marked, errors);
}

TEST(Coverage, OfMarkerRingsIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(10, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, taper_or_none(random, 0.004));
    const Backbone backbone = bent.backbone();
    compare_rings(bent, backbone, random_view_of(random, backbone), 0.1, errors);
  });
  errors.expect_small();
}

TEST(Coverage, OfRingsFinerThanPixelsIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(6, [&](TestRandom& random) {
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
  for_random_cases(8, [&](TestRandom& random) {
    BentArm bent = random_bent_arm(random, taper_or_none(random, 0.003), taper_or_none(random, 0.003));
    const double thickness = std::exp(random.uniform(-1.5, 0.7));
    for (Section& section : bent.arm.sections) {
      for (double& radius : section.radius) radius *= thickness;
    }
    const Backbone backbone = bent.backbone();
    View view = aimed(random_view_of(random, backbone), backbone, random.uniform(0, backbone.length()),
                      200 * std::exp(random.uniform(-1, 2)));
    Intrinsics lens = view.lens.intrinsics();
    // As much of it at the picture's edge whatever the focal length.
    const double wide = std::pow(lens.fx / 200, 2);
    if (random.integer(0, 1) == 0) lens.distortion = {random.uniform(-0.3, 0.3) * wide, 0, 0.001, -0.001, 0};
    view.lens = Lens(lens);
    compare_silhouettes(bent, backbone, view, errors);
    compare_rings(bent, backbone, view, 0.11, errors);  // None over a step.
  });
  errors.expect_small();
}

// The mean of what samples x samples rays of a pixel show.
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

// The errors of the exact picture against the same surfaces, sampled.
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

// Where everything stands in the way of everything.
TEST(Coverage, OfCrowdedScenesIsThatOfTheirRays) {
  CoverageErrors errors;
  for_random_cases(5, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.003);
    const Backbone backbone = bent.backbone();
    View view = random_view_of(random, backbone);
    Intrinsics lens = view.lens.intrinsics();
    lens.distortion = {-0.2, 0.05, 0.001, 0.001, 0};
    view.lens = Lens(lens);
    compare_with_rays(crowded_scene(random, bent, backbone), view, errors);
  });
  errors.expect_small("crowded");
}

// Disks where the radius steps, and a second one; seen near by. With `wildness` 1 the arm keeps clear of its
// disks, with more it passes through them.
void compare_disks(TestRandom& random, double wildness, CoverageErrors& errors) {
  BentArm bent = random_bent_arm(random, 0, 0.008);
  for (Eigen::Vector2d& bend : bent.state.bends) bend *= wildness;
  const Backbone backbone = bent.backbone();
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(bent.arm, backbone);
  scene.arm.albedo = {0.2, 0.2, 0.2}, scene.arm.disk_albedo = {1, 1, 1};
  const double step = backbone.arcs()[1].s;
  scene.arm.disks = {{step, 0.05, 0.01}, {step + random.uniform(-0.1, 0.1), 0.06, 0.004}};
  const View view = aimed(random_view_of(random, backbone), backbone, step, random.uniform(300, 900));
  compare_with_rays(scene, view, errors);
}

TEST(Coverage, OfDisksOnStepsOfTheRadiusIsThatOfTheirRays) {
  CoverageErrors errors;
  for_random_cases(12, [&](TestRandom& random) { compare_disks(random, 1, errors); });
  errors.expect_small("disks");
}

TEST(Coverage, OfDisksThatTheArmPassesThroughIsThatOfTheirRays) {
  CoverageErrors errors;
  for_random_cases(12, [&](TestRandom& random) { compare_disks(random, 2.5, errors); });
  errors.expect_small("cut disks");
}

}  // namespace
}  // namespace flexura
