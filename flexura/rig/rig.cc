#include "flexura/rig/rig.h"

#include "flexura/port/camera_moves.h"

namespace flexura {

std::vector<CameraReading> camera_readings(const RigPorts& ports, const std::vector<Camera>& optics) {
  std::vector<CameraReading> readings;
  for (std::size_t i = 0; i < ports.cameras.size(); ++i) {
    const CameraStance measured = measured_stance(ports.cameras[i], optics.at(i)).value();
    readings.push_back({measured.head, measured.stage});
  }
  return readings;
}

}  // namespace flexura
