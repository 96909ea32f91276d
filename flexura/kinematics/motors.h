#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"

// Converts tendon displacements to motor positions and back (docs/drives.md). A motor position is a number of
// microsteps, positive in the motor's own direction. Position 0 corresponds to the straight, unstretched arm,
// with the backlash compensated for pulling in.
namespace flexura {

/// Returns each motor's position for tendon displacements, in microsteps, without rounding, backlash and
/// friction.
/// Throws std::invalid_argument unless there is one displacement per axis.
[[nodiscard]] std::vector<double> motor_positions(const Drive& drive,
                                                  const TendonDisplacements& displacements);

/// Returns the tendon displacements at motor positions, microsteps, without backlash and friction. Throws
/// std::invalid_argument unless there is one position per axis.
[[nodiscard]] TendonDisplacements displacements_at(const Drive& drive, std::span<const double> positions);

/// Computes the motor positions to command so that tendons follow target displacements. The positions are
/// rounded to the nearest microstep, and compensate the whole backlash as soon as a tendon reverses. If the
/// displacements include wraps, the positions also compensate the travel that friction takes: half of the
/// travel in either direction. Thus each tendon remains within half a microstep of its target.
class MotorCommander {
 public:
  /// Starts at the displacements `start`, with backlash and friction compensated for pulling in. Throws
  /// std::invalid_argument unless there is one displacement per axis, and one wrap per axis or none.
  MotorCommander(const Drive& drive, const TendonDisplacements& start);

  /// Returns the positions to command, microsteps.
  [[nodiscard]] const std::vector<std::int64_t>& positions() const { return positions_; }
  /// Returns the positions before rounding, microsteps.
  [[nodiscard]] const std::vector<double>& targets() const { return targets_; }
  /// Returns by how much the last follow() moved each motor only because its tendon reversed, microsteps:
  /// backlash and lost travel; >= 0.
  [[nodiscard]] const std::vector<double>& taken_up() const { return taken_up_; }
  /// Computes the positions for the displacements `desired`. Throws std::out_of_range if a position is NaN,
  /// or if its magnitude is above 2^53. Throws std::invalid_argument as the constructor.
  void follow(const TendonDisplacements& desired);

 private:
  // The direction of a motion. Rounding errors do not reverse it.
  struct Side {
    bool letting_out = false;
    double farthest = 0;  // Extreme position since the last reversal, microsteps pulled in.

    // Returns whether the motion to `target`, microsteps pulled in, is a reversal.
    bool follow(double target);
  };
  // The tendon moves against friction; its spool moves behind the backlash.
  struct Sides {
    Side tendon, spool;
  };
  void command(std::size_t axis, double target);

  std::vector<Axis> axes_;
  std::vector<Sides> sides_;
  std::vector<std::int64_t> positions_;
  std::vector<double> targets_, taken_up_;
};

}  // namespace flexura
