#include "flexura/equipment/guarded_drive.h"

#include <fmt/format.h>

#include <utility>

namespace flexura {

GuardedDrive::GuardedDrive(DrivePort& drive, Watchdog& guard, std::function<void()> keep_alive,
                           double time_shift)
    : drive_(drive), guard_(guard), keep_alive_(std::move(keep_alive)), time_shift_(time_shift) {}

void GuardedDrive::beat() {
  if (!guard_.beat(is_moving_)) was_stopped_ = true;
  if (keep_alive_) keep_alive_();
}

PortFault GuardedDrive::stopped() const {
  return {FaultKind::refused,
          fmt::format("the watchdog stopped all devices, because the program was silent for more than {:g} s "
                      "while the arm moved",
                      guard_.period())};
}

CommandOutcome GuardedDrive::command(std::span<const double> targets, double duration) {
  is_moving_ = true;
  beat();
  if (was_stopped_.exchange(false)) {
    is_moving_ = false;
    return stopped();
  }
  CommandOutcome outcome = drive_.command(targets, duration);
  // A controller may move although its answer was lost.
  beat();
  return outcome;
}

CommandOutcome GuardedDrive::halt() {
  CommandOutcome outcome = drive_.halt();
  beat();
  return outcome;
}

Outcome<DriveReading> GuardedDrive::read() {
  beat();
  auto taken = drive_.read();
  beat();
  // A stop makes some controllers lose their position: the stop is the cause to report.
  if (!taken && was_stopped_) return stopped();
  if (!taken) return taken;
  DriveReading reading = std::move(taken).value();
  is_moving_ = reading.moving;
  reading.time += time_shift_;
  return reading;
}

}  // namespace flexura
