#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"

// Converts displacements to motor positions and back (docs/drives.md). A position counts microsteps in the
// motor's own direction. All are 0 where the arm is straight and unstretched, with the backlash compensated
// for pulling in.
namespace flexura {

/// Returns each motor's position for these displacements, not rounded, without backlash. Throws
/// std::invalid_argument unless there is one displacement per axis.
[[nodiscard]] std::vector<double> motor_positions(const Drive& drive,
                                                  const TendonDisplacements& displacements);

/// Returns the displacements at these positions, without backlash. Throws std::invalid_argument unless there
/// is one position per axis.
[[nodiscard]] TendonDisplacements displacements_at(const Drive& drive, std::span<const double> positions);

/// Computes the positions to command so that the tendons follow target displacements. Rounds to the nearest
/// microstep and compensates the backlash at once where a tendon reverses. Every tendon then stays within
/// half a microstep of its target.
class MotorCommander {
 public:
  /// Starts at `start`, with the backlash compensated for pulling in. Throws std::invalid_argument if `start`
  /// does not fit the drive.
  MotorCommander(const Drive& drive, const TendonDisplacements& start);

  /// Returns the current positions, microsteps.
  [[nodiscard]] const std::vector<std::int64_t>& positions() const { return positions_; }
  /// Returns the positions before rounding.
  [[nodiscard]] const std::vector<double>& targets() const { return targets_; }
  /// Moves to `desired`. Throws std::out_of_range if a position is beyond 2^53 or not a number.
  void follow(const TendonDisplacements& desired);

 private:
  struct Side {
    bool letting_out = false;  // Pays out, with the backlash compensated for that.
    double farthest = 0;       // Extreme position of the tendon on this side, microsteps pulled in.
  };
  void command(std::size_t axis, double target);

  std::vector<Axis> axes_;
  std::vector<Side> sides_;
  std::vector<std::int64_t> positions_;
  std::vector<double> targets_;
};

}  // namespace flexura
