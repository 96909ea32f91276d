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

/// Counts of the pictures of a camera in a rehearsal.
struct RehearsedPictures {
  std::int64_t sent = 0;     ///< Number of pictures sent to a program.
  std::int64_t skipped = 0;  ///< Number of pictures that were not rendered because the computer is too slow.
};

/// The simulated rig of an experiment, in real time, with simulated devices. The devices are stepper
/// controllers with Grbl on pseudoterminals, VISCA heads at UDP ports, and cameras that send video over RTSP.
/// So a program can run the experiment with its real drivers but without hardware.
class Rehearsal {
 public:
  /// Starts the devices. Simulates the rig of `setup`, including [truth]; a table [rig] is ignored. Throws
  /// std::invalid_argument with one clear line if the setup has no drive or its pictures have other than 8
  /// bits, and std::runtime_error in the same cases as open_video_server().
  explicit Rehearsal(const Setup& setup, const VideoServerConfig& video = {});
  /// Stops the devices.
  ~Rehearsal();
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  /// Returns the table [rig] that connects a program to the devices.
  [[nodiscard]] RigEquipment equipment() const;
  /// Returns the reason why the simulation has ended, for example the collapse of an elastic arm; "" while it
  /// runs.
  [[nodiscard]] std::string failure() const;
  /// Returns how often arm and heads were moved back to their initial positions.
  [[nodiscard]] int runs() const;
  /// Returns the numbers of pictures of a camera so far.
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
