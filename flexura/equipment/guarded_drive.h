#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>

#include "flexura/equipment/guard.h"
#include "flexura/port/drive_port.h"

namespace flexura {

/// A drive with a watchdog. The watchdog stops all devices if this object sends no beat for a period while
/// the drive moves. Code that waits must call beat(). The drive's clock may have another origin than the
/// rig's clock. All functions may be called from several threads if the functions of the drive may.
class GuardedDrive : public DrivePort {
 public:
  /// Drive and watchdog must outlive this object. `keep_alive`, if any, is called with every beat.
  /// `time_shift`, s, is added to the times of readings.
  GuardedDrive(DrivePort& drive, Watchdog& guard, std::function<void()> keep_alive = {},
               double time_shift = 0);

  [[nodiscard]] DriveQuantity quantity() const override { return drive_.quantity(); }
  [[nodiscard]] std::size_t axes() const override { return drive_.axes(); }
  /// Refuses the command if the watchdog has stopped the devices since the last command. The next command is
  /// accepted again.
  CommandOutcome command(std::span<const double> targets, double duration) override;
  CommandOutcome halt() override;
  /// If the drive does not answer after the watchdog has stopped the devices, the fault says so.
  Outcome<DriveReading> read() override;

  /// Sends the watchdog a sign of life.
  void beat();

 private:
  // The fault after a stop by the watchdog.
  [[nodiscard]] PortFault stopped() const;

  DrivePort& drive_;
  Watchdog& guard_;
  std::function<void()> keep_alive_;
  double time_shift_;
  std::atomic<bool> is_moving_ = false, was_stopped_ = false;
};

}  // namespace flexura
