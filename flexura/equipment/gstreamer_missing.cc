// Stands in for gstreamer_camera.cc in a build without GStreamer.
#include "flexura/equipment/gstreamer_camera.h"

namespace flexura {

bool has_gstreamer() { return false; }

Outcome<std::unique_ptr<CountedCamera>> open_gstreamer_camera(const GStreamerConfig& /*config*/,
                                                              const CameraConfig& camera,
                                                              const ClockPort& /*clock*/) {
  return PortFault{FaultKind::refused,
                   camera_prefix(camera.name) +
                       "this program was built without GStreamer: install libgstreamer1.0-dev and "
                       "libgstreamer-plugins-base1.0-dev, then build again"};
}

}  // namespace flexura
