#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Three to five tendons a section that determine its bend and stretch: spread around the arm, but unevenly,
/// at different radii (mm to cm), on axes of different gears and senses.
inline Drive random_drive(TestRandom& random, const Arm& arm) {
  Drive drive;
  for (std::size_t section = 0; section < arm.sections.size(); ++section) {
    const int count = random.integer(3, 5);
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    for (int i = 0; i < count; ++i) {
      const double angle = turn + (i + random.uniform(-0.25, 0.25)) * 2 * std::numbers::pi / count;
      drive.tendons.push_back({section, random.uniform(0.004, 0.03), angle});
      Axis& axis = drive.axes.emplace_back();
      axis.motor.steps = 100 * axis.motor.phases * random.integer(1, 2);
      axis.motor.microsteps = random.integer(1, 16);
      axis.spool = {random.uniform(0.005, 0.02), random.uniform(1, 20), random.uniform(0, 0.05)};
      axis.reversed = random.integer(0, 1) == 1;
    }
  }
  return drive;
}

/// Two tendons a section, which determine its bend and nothing else.
inline Drive random_scanty_drive(TestRandom& random, const Arm& arm) {
  Drive drive = random_drive(random, arm);
  Drive scanty = drive;
  scanty.tendons.clear(), scanty.axes.clear();
  for (std::size_t i = 0; i < drive.tendons.size(); ++i) {
    if (i >= 2 && drive.tendons[i - 2].section == drive.tendons[i].section) continue;
    scanty.tendons.push_back(drive.tendons[i]);
    scanty.axes.push_back(drive.axes[i]);
  }
  return scanty;
}

/// What the mechanism makes of commands: each spool follows its motor within the play, and stays where it is
/// while the motor turns through it. At first the play is taken up for pulling in.
class BacklashModel {
 public:
  BacklashModel(const Drive& drive, const std::vector<std::int64_t>& positions) : axes_(drive.axes) {
    for (std::size_t i = 0; i < axes_.size(); ++i) spools_.push_back(motor(i, positions));
  }
  void follow(const std::vector<std::int64_t>& positions) {
    for (std::size_t i = 0; i < axes_.size(); ++i)
      spools_[i] =
          std::clamp(spools_[i], motor(i, positions), motor(i, positions) + axes_[i].backlash_steps());
  }
  [[nodiscard]] TendonDisplacements displacements() const {
    TendonDisplacements made;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      made.pulled.push_back(spools_[i] / axes_[i].microsteps_a_metre());
    return made;
  }

 private:
  [[nodiscard]] double motor(std::size_t i, const std::vector<std::int64_t>& positions) const {
    return (axes_[i].reversed ? -1.0 : 1.0) * static_cast<double>(positions[i]);
  }

  std::vector<Axis> axes_;
  std::vector<double> spools_;  // microsteps pulled in
};

}  // namespace flexura
