#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/descriptor.h"
#include "flexura/camera/camera.h"
#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/link.h"
#include "flexura/equipment/visca_config.h"
#include "flexura/equipment/visca_device.h"
#include "flexura/model/drive.h"
#include "flexura/rig/rehearsed_world.h"

namespace flexura {

/// A simulated stepper controller on a pseudoterminal, with Grbl for three axes, otherwise with grblHAL.
class RehearsedController {
 public:
  /// The controller has the speed and acceleration limits of the motors of `axes`, which are at most 8.
  /// Motors without limits get the limits of fast motors.
  explicit RehearsedController(const std::vector<Axis>& axes)
      : RehearsedController(axes, open_serial_pair()) {}

  /// Returns the path of the serial line.
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::size_t axes() const { return axes_; }
  /// Returns the motors' positions since the start, microsteps.
  [[nodiscard]] std::vector<double> positions();
  /// Turns all motors back by a fraction of the distance to their initial positions, without the controller's
  /// knowledge.
  void turn_back(double share);

 private:
  RehearsedController(const std::vector<Axis>& axes, SerialPair pair);

  std::size_t axes_;
  std::string path_;
  Descriptor kept_;
  GrblDevice device_;
  DeviceServer server_;
};

/// A simulated VISCA head at a UDP port, which moves the head of a camera in a RehearsedWorld. The head moves
/// at the rates of the head in the RehearsedWorld, not at the speed in the command. All axes of the head stop
/// at the same time.
class RehearsedHead {
 public:
  /// `camera`: index of the camera in the world. `model`: model of the camera. The world must outlive this
  /// object.
  RehearsedHead(RehearsedWorld& world, std::size_t camera, const Camera& model)
      : RehearsedHead(world, camera, model, open_udp_place()) {}

  /// Returns the configuration by which a program connects to the head. A count is one step of an axis.
  [[nodiscard]] const ViscaConfig& config() const { return config_; }

 private:
  RehearsedHead(RehearsedWorld& world, std::size_t camera, const Camera& model, UdpPlace place);

  ViscaConfig config_;
  std::unique_ptr<ViscaDevice> device_;
  DeviceServer server_;
};

}  // namespace flexura
