#include "flexura/sim/driven_shapes.h"

#include <algorithm>
#include <cmath>

#include "flexura/port/driven_arm.h"

namespace flexura {

DrivenShapes::DrivenShapes(const Arm& arm, const Drive& drive, const ArmState& initial,
                           const std::vector<std::int64_t>& start, double horizon)
    : arm_(arm),
      drive_(drive),
      zero_(displacements_at_zero(arm, drive, initial, start)),
      loses_travel_(drive.loses_travel()),
      play_(arm, drive, initial),
      horizon_(horizon) {}

void DrivenShapes::advance(double time, const DriveMotors& motors) {
  latest_ = std::max(latest_, time);
  forget_before(time - horizon_, motors);
}

void DrivenShapes::forget_before(double time, const DriveMotors& motors) {
  if (!loses_travel_ || !(time > 0)) return;
  const long last = static_cast<long>(std::floor(time / step));
  while (index_ < last) {
    ++index_;
    play_.follow(spools(static_cast<double>(index_) * step, motors));
  }
}

std::vector<double> DrivenShapes::spools(double time, const DriveMotors& motors) const {
  return displacements_carried(drive_, zero_, motors.carried(time)).pulled;
}

ArmState DrivenShapes::at(double time, const DriveMotors& motors) const {
  if (!loses_travel_) return shape_carried(arm_, drive_, zero_, motors.carried(time));
  FrictionPlay play = play_;
  for (long next = index_ + 1; static_cast<double>(next) * step < time; ++next) {
    const double then = static_cast<double>(next) * step;
    play.follow(spools(then, motors));
    // Afterwards nothing moves.
    if (then > latest_ && !motors.is_moving(then)) break;
  }
  return play.follow(spools(time, motors));
}

}  // namespace flexura
