#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "flexura/equipment/rig_equipment.h"
#include "flexura/equipment/video_server.h"
#include "flexura/model/backbone.h"
#include "flexura/port/rig_model.h"
#include "flexura/rig/setup.h"

namespace flexura {

/// Pictures of a rehearsed camera.
struct RehearsedPictures {
  std::int64_t sent = 0;     ///< Pictures sent to a program.
  std::int64_t skipped = 0;  ///< Pictures that were not rendered, because the machine is too slow.
};

/// The simulated rig of an experiment behind simulated devices, in real time. The devices are stepper
/// controllers that speak Grbl on pseudoterminals, heads that speak VISCA over UDP, and cameras that serve
/// video over RTSP. A program that runs the experiment on this equipment needs no hardware.
class Rehearsal {
 public:
  /// Starts the devices. The world is that of `setup`, including [truth]; a table [rig] is ignored. Throws
  /// std::invalid_argument with one clear line if the setup has no drive or its pictures have other than 8
  /// bits, and std::runtime_error as open_video_server().
  explicit Rehearsal(const Setup& setup, const VideoServerConfig& video = {});
  /// Ends the devices.
  ~Rehearsal();
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  /// Returns the table [rig] that connects a program to the devices.
  [[nodiscard]] RigEquipment equipment() const;
  /// Returns why the simulation has ended, for example an elastic arm that collapsed; "" while it goes on.
  [[nodiscard]] std::string failure() const;
  /// Returns how often arm and heads went back to their initial positions.
  [[nodiscard]] int runs() const;
  /// Returns the number of pictures of a camera up to now.
  [[nodiscard]] RehearsedPictures pictures(std::size_t camera) const;
  /// Returns the arm's true backbone now.
  [[nodiscard]] Backbone backbone();
  /// Returns the true axis positions of a camera now.
  [[nodiscard]] RigStance stance(std::size_t camera);

 private:
  class Devices;
  std::unique_ptr<Devices> devices_;
};

}  // namespace flexura
