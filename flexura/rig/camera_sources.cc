#include "flexura/rig/camera_sources.h"

namespace flexura {

std::unique_ptr<CountedCamera> open_camera_source(const CameraEquipment& equipment,
                                                  const CameraConfig& camera, const ClockPort& clock) {
  if (equipment.gstreamer) return open_gstreamer_camera(*equipment.gstreamer, camera, clock).value();
  if (equipment.aravis) return open_aravis_camera(*equipment.aravis, camera, clock).value();
  return open_v4l2_camera(equipment.v4l2.value(), camera, clock).value();
}

CameraSourceText camera_source_text(const CameraEquipment& equipment) {
  if (equipment.gstreamer) return {"GStreamer", equipment.gstreamer->source};
  if (equipment.aravis)
    return {"Aravis", equipment.aravis->device.empty() ? "first found" : equipment.aravis->device};
  return {"V4L2", equipment.v4l2.value().device};
}

}  // namespace flexura
