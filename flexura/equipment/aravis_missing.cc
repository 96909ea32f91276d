// Stands in for aravis_camera.cc in a build without Aravis.
#include "flexura/equipment/aravis_camera.h"

namespace flexura {

bool has_aravis() { return false; }

std::vector<std::string> aravis_cameras() { return {}; }

Outcome<std::unique_ptr<CountedCamera>> open_aravis_camera(const AravisConfig& /*config*/,
                                                           const CameraConfig& camera,
                                                           const ClockPort& /*clock*/) {
  return PortFault{FaultKind::refused,
                   camera_prefix(camera.name) +
                       "this program was built without Aravis: install libaravis-dev, then build again"};
}

}  // namespace flexura
