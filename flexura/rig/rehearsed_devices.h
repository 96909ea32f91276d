#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/equipment/descriptor.h"
#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/link.h"
#include "flexura/equipment/visca_config.h"
#include "flexura/equipment/visca_device.h"
#include "flexura/model/drive.h"
#include "flexura/rig/rehearsed_world.h"

namespace flexura {

/// A simulated stepper controller on a pseudoterminal: Grbl for three axes, otherwise grblHAL.
class RehearsedController {
 public:
  /// The controller has the limits of the motors of `axes`, at most 8; where these have none, those of fast
  /// motors.
  explicit RehearsedController(const std::vector<Axis>& axes)
      : RehearsedController(axes, open_serial_pair()) {}

  /// Returns the path of the serial line.
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::size_t axes() const { return axes_; }
  /// Returns the motors' positions since the start, microsteps.
  [[nodiscard]] std::vector<double> positions();
  /// Turns all motors by hand by a share of their way back to the start.
  void turn_back(double share);

 private:
  RehearsedController(const std::vector<Axis>& axes, SerialPair pair);

  std::size_t axes_;
  std::string path_;
  Descriptor kept_;
  GrblDevice device_;
  DeviceServer server_;
};

/// A simulated VISCA head at a UDP port, whose motors are those of a camera of a world. It moves at the rates
/// of the world's head, whatever the speed in a command, and its axes stop together.
class RehearsedHead {
 public:
  /// `camera`: index in the world, and `model` its model. The world must outlive this object.
  RehearsedHead(RehearsedWorld& world, std::size_t camera, const Camera& model)
      : RehearsedHead(world, camera, model, open_udp_place()) {}

  /// Returns how a program connects to the head. The head has one count for each step of its axes.
  [[nodiscard]] const ViscaConfig& config() const { return config_; }

 private:
  RehearsedHead(RehearsedWorld& world, std::size_t camera, const Camera& model, UdpPlace place);

  ViscaConfig config_;
  std::unique_ptr<ViscaDevice> device_;
  DeviceServer server_;
};

}  // namespace flexura
