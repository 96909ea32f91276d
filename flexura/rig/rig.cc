#include "flexura/rig/rig.h"

namespace flexura {

std::vector<CameraReading> camera_readings(const RigPorts& ports) {
  std::vector<CameraReading> readings;
  for (const CameraPorts& camera : ports.cameras)
    readings.push_back({camera.head->read().value().state, camera.stage->read().value().state});
  return readings;
}

}  // namespace flexura
