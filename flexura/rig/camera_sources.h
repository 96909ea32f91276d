#pragma once

#include <memory>
#include <string>

#include "flexura/camera/camera_config.h"
#include "flexura/equipment/camera_feed.h"
#include "flexura/equipment/rig_equipment.h"
#include "flexura/port/clock_port.h"

namespace flexura {

/// Starts the source of a camera's pictures. `clock` must outlive it. Throws std::runtime_error with one
/// clear line if it cannot be used.
[[nodiscard]] std::unique_ptr<CountedCamera> open_camera_source(const CameraEquipment& equipment,
                                                                const CameraConfig& camera,
                                                                const ClockPort& clock);

/// The driver of a camera's pictures and its address in the file.
struct CameraSourceText {
  std::string driver, place;
};
/// Returns the names of a camera's source, for messages.
[[nodiscard]] CameraSourceText camera_source_text(const CameraEquipment& equipment);

}  // namespace flexura
