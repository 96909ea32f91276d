#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"

// Displacements to motor positions and back (docs/drives.md). A position counts microsteps in
// the motor's own sense; all are 0 where the arm is straight and unstretched and the play is taken up for
// pulling in.
namespace flexura {

/// Each motor's position for these displacements, not rounded, without regard to play.
/// std::invalid_argument when there is not one displacement an axis.
[[nodiscard]] std::vector<double> motor_positions(const Drive& drive,
                                                  const TendonDisplacements& displacements);

/// The displacements at these positions (one an axis, else std::invalid_argument), without regard to play.
[[nodiscard]] TendonDisplacements displacements_at(const Drive& drive, std::span<const double> positions);

/// Which positions to command so that the tendons follow wanted displacements: to the nearest microstep, and
/// with the play taken up at once where a tendon reverses. Behind these commands every tendon stays within
/// half a microstep of what is wanted.
class MotorCommander {
 public:
  /// At `start`, with the play taken up for pulling in. std::invalid_argument when it does not fit the drive.
  MotorCommander(const Drive& drive, const TendonDisplacements& start);

  /// The positions now, microsteps.
  [[nodiscard]] const std::vector<std::int64_t>& positions() const { return positions_; }
  /// What they are rounded from: the way of the motors without the steps of counting.
  [[nodiscard]] const std::vector<double>& targets() const { return targets_; }
  /// Goes on to `wanted`. std::out_of_range when a position is beyond 2^53, or not a number.
  void follow(const TendonDisplacements& wanted);

 private:
  struct Side {
    bool letting_out = false;  // and the play is taken up for that
    double farthest = 0;       // how far the tendon has come on this side, microsteps pulled in
  };
  void command(std::size_t axis, double target);

  std::vector<Axis> axes_;
  std::vector<Side> sides_;
  std::vector<std::int64_t> positions_;
  std::vector<double> targets_;
};

}  // namespace flexura
