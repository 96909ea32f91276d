#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "flexura/camera/camera_config.h"
#include "flexura/sim/rig_config.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {

/// Returns a rig with the paper's two cameras and a spatial arm of two sections with three tendons each. Its
/// motors have limits and backlash.
inline RigConfig two_section_rig() {
  RigConfig rig;
  rig.arm.kind = ArmKind::spatial;
  rig.arm.section.resize(2);
  for (Section& section : rig.arm.section) section.length = 0.25, section.max_bend_rate = 0.5;
  DriveConfig& drive = rig.drive.emplace();
  drive.motor.max_speed = 20, drive.motor.max_acceleration = 100;
  drive.spool.backlash = 0.02;
  for (int i = 0; i < 6; ++i) {
    TendonConfig& tendon = drive.tendon.emplace_back();
    tendon.section = i < 3 ? 1 : 2;
    tendon.angle = 2 * std::numbers::pi * i / 3 + (i < 3 ? 0 : 0.5);
    tendon.reversed = i % 2 == 1;
  }
  rig.cameras = default_cameras(0.5);
  for (CameraConfig& camera : rig.cameras)
    camera.sensor.width = 64, camera.sensor.height = 48, camera.lens.fx = 80;
  return rig;
}

/// Renders images that store what they show as exact numbers: the pixels of points along the arm at the start
/// of the exposure, and the frame number.
inline Picture numbers_renderer(const Shot& shot) {
  Image<std::uint8_t> image(static_cast<int>(shot.sensor->width), static_cast<int>(shot.sensor->height),
                            shot.sensor->channels());
  const Backbone backbone = shot.backbone(shot.start);
  const View view = shot.view(shot.start);
  std::array<double, 12> numbers{};
  for (std::size_t i = 0; i < 5; ++i) {
    const double s = backbone.length() * static_cast<double>(i + 1) / 5;
    const auto pixel = view.project(backbone.pose(s).position);
    if (pixel) numbers[2 * i] = pixel->x(), numbers[2 * i + 1] = pixel->y();
  }
  numbers[10] = shot.start;
  numbers[11] = static_cast<double>(shot.frame);
  std::memcpy(image.values().data(), numbers.data(), sizeof numbers);
  return image;
}

/// Returns the numbers stored in such an image.
inline std::array<double, 12> numbers_of(const Frame& frame) {
  std::array<double, 12> numbers{};
  std::memcpy(numbers.data(), std::get<Image<std::uint8_t>>(*frame.picture).values().data(), sizeof numbers);
  return numbers;
}

}  // namespace flexura
