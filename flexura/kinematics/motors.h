#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"

// Converts tendon displacements to motor positions and back (docs/drives.md). A motor position is a number of
// microsteps, positive in the motor's own direction. Position 0 corresponds to the straight, unstretched arm,
// with the backlash compensated for pulling in.
namespace flexura {

/// Returns each motor's position for tendon displacements, in microsteps, without rounding and backlash.
/// Throws std::invalid_argument unless there is one displacement per axis.
[[nodiscard]] std::vector<double> motor_positions(const Drive& drive,
                                                  const TendonDisplacements& displacements);

/// Returns the tendon displacements at motor positions, microsteps, without backlash. Throws
/// std::invalid_argument unless there is one position per axis.
[[nodiscard]] TendonDisplacements displacements_at(const Drive& drive, std::span<const double> positions);

/// Computes the motor positions to command so that tendons follow target displacements. The positions are
/// rounded to the nearest microstep, and compensate the whole backlash as soon as a tendon reverses. Thus
/// each tendon remains within half a microstep of its target.
class MotorCommander {
 public:
  /// Starts at the displacements `start`, with the backlash compensated for pulling in. Throws
  /// std::invalid_argument unless there is one displacement per axis.
  MotorCommander(const Drive& drive, const TendonDisplacements& start);

  /// Returns the positions to command, microsteps.
  [[nodiscard]] const std::vector<std::int64_t>& positions() const { return positions_; }
  /// Returns the positions before rounding, microsteps.
  [[nodiscard]] const std::vector<double>& targets() const { return targets_; }
  /// Computes the positions for the displacements `desired`. Throws std::out_of_range if a position is NaN,
  /// or if its magnitude is above 2^53.
  void follow(const TendonDisplacements& desired);

 private:
  struct Side {
    // Whether the tendon is being let out, with the backlash compensated for this direction.
    bool letting_out = false;
    double farthest = 0;  // Extreme position since the last reversal, microsteps pulled in.
  };
  void command(std::size_t axis, double target);

  std::vector<Axis> axes_;
  std::vector<Side> sides_;
  std::vector<std::int64_t> positions_;
  std::vector<double> targets_;
};

}  // namespace flexura
