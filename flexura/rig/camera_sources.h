#pragma once

#include <memory>
#include <string>

#include "flexura/camera/camera_config.h"
#include "flexura/equipment/camera_feed.h"
#include "flexura/equipment/rig_equipment.h"
#include "flexura/port/clock_port.h"

namespace flexura {

/// Starts the driver that receives a camera's pictures. `clock` must outlive it. Throws std::runtime_error
/// with one clear line if the driver cannot be used.
[[nodiscard]] std::unique_ptr<CountedCamera> open_camera_source(const CameraEquipment& equipment,
                                                                const CameraConfig& camera,
                                                                const ClockPort& clock);

/// The driver of a camera's pictures, and the camera's address in the file.
struct CameraSourceText {
  std::string driver, place;
};
/// Returns the driver and the address of a camera, for messages.
[[nodiscard]] CameraSourceText camera_source_text(const CameraEquipment& equipment);

}  // namespace flexura
