#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "flexura/camera/camera.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Returns zoom ratios and motor counts of an 18x zoom lens (Sony block camera, from its manual).
inline std::vector<ZoomRow> sony_zoom() {
  constexpr std::array<int, 18> counts = {0x0000, 0x1606, 0x2151, 0x2860, 0x2CB5, 0x3060,
                                          0x32D3, 0x3545, 0x3727, 0x38A9, 0x3A42, 0x3B4B,
                                          0x3C85, 0x3D75, 0x3E4E, 0x3EF7, 0x3FA0, 0x4000};
  std::vector<ZoomRow> rows;
  for (const int count : counts) {
    ZoomRow& row = rows.emplace_back();
    row.ratio = static_cast<double>(rows.size());
    row.count = count;
  }
  return rows;
}

/// Returns a random lens with a zoom table in which every parameter varies, given by ratio or by rising or
/// falling counts.
inline LensConfig random_lens(TestRandom& random) {
  LensConfig lens;
  lens.fx = random.uniform(300, 2000), lens.fy = lens.fx * random.uniform(0.95, 1.05);
  lens.distortion = {random.uniform(-0.2, 0.1), random.uniform(-0.02, 0.02), random.uniform(-0.003, 0.003),
                     random.uniform(-0.003, 0.003), 0};
  const int rows = random.integer(1, 6), way = random.integer(0, 2);
  for (int i = 0; rows > 1 && i < rows; ++i) {
    ZoomRow& row = lens.zoom.emplace_back();
    row.ratio = std::pow(1.6, i) * random.uniform(0.9, 1.1);
    if (way > 0) row.count = (way == 1 ? 100.0 : -100.0) * (i + random.uniform(-0.3, 0.3));
    row.fx = lens.fx * row.ratio, row.fy = *lens.fy * row.ratio * random.uniform(0.97, 1.03);
    row.cx = random.uniform(300, 340), row.cy = random.uniform(220, 260);
    row.distortion = lens.distortion;
    for (double& coefficient : *row.distortion) coefficient *= random.uniform(0.2, 1);
  }
  return lens;
}

/// Returns a random camera with offsets between its axes, a pupil shifted by the zoom, and limited travel of
/// each axis.
inline CameraConfig random_camera(TestRandom& random) {
  CameraConfig camera;
  camera.name = "random";
  for (double& coordinate : camera.mount.position) coordinate = random.uniform(-5, 5);
  camera.mount.look_at = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  camera.mount.roll = random.uniform(-0.5, 0.5);
  for (SlideConfig* slide : {&camera.mount.stage.x, &camera.mount.stage.y, &camera.mount.stage.z})
    slide->limits = {-random.uniform(0, 1), random.uniform(0, 1)};
  for (double& offset : camera.head.tilt_axis) offset = random.uniform(-0.1, 0.1);
  for (double& offset : camera.head.pupil) offset = random.uniform(-0.1, 0.1);
  camera.head.pupil_shift = random.uniform(-0.01, 0.01);
  camera.lens = random_lens(random);
  return camera;
}

/// Returns random positions within the limits of the camera's axes.
inline HeadState random_head(TestRandom& random, const Camera& camera) {
  const auto& [pan, tilt, zoom] = camera.head_axes();
  return {random.uniform(pan.limits[0], pan.limits[1]), random.uniform(tilt.limits[0], tilt.limits[1]),
          random.uniform(zoom.limits[0], zoom.limits[1])};
}
inline StageState random_stage(TestRandom& random, const Camera& camera) {
  StageState stage;
  for (int i = 0; i < 3; ++i) {
    const auto limits = camera.stage_axes()[static_cast<std::size_t>(i)].limits;
    stage.offset[i] = random.uniform(limits[0], limits[1]);
  }
  return stage;
}

}  // namespace flexura
