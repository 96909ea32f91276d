#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"

// Displacements to spool turns to motor positions and back (docs/drives.md). A position counts microsteps in
// the motor's own sense; all are 0 where the arm is straight and unstretched and the play is taken up for
// pulling in.
namespace flexura {

/// Turns of the spool that pull in `pulled` m; negative where cable is let out.
[[nodiscard]] double spool_turns(const Axis& axis, double pulled);

/// Each motor's position for these displacements, not rounded, without regard to play.
/// std::invalid_argument when there is not one displacement an axis.
[[nodiscard]] std::vector<double> motor_positions(const Drive& drive,
                                                  const TendonDisplacements& displacements);

/// The displacements at these positions (one an axis, else std::invalid_argument), without regard to play.
[[nodiscard]] TendonDisplacements displacements_at(const Drive& drive, std::span<const double> positions);

/// Which positions to command so that the tendons follow wanted displacements: to the nearest microstep, and
/// with the play taken up at once where a tendon reverses. Behind these commands `PlayModel` keeps every
/// tendon within half a microstep of what is wanted.
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

/// What the mechanism makes of commands: the spool follows its motor within the play, and stays where it is
/// while the motor turns through it (the play operator).
class PlayModel {
 public:
  /// The motors at `positions`, microsteps, with the play taken up for pulling in. std::invalid_argument when
  /// there is not one an axis.
  PlayModel(const Drive& drive, std::span<const std::int64_t> positions);

  /// How far each tendon is pulled in now, m, by its spool and not by its motor.
  [[nodiscard]] TendonDisplacements displacements() const;
  /// The motors go to `positions` (one an axis, else std::invalid_argument), each straight there.
  void follow(std::span<const std::int64_t> positions);

 private:
  std::vector<Axis> axes_;
  std::vector<double> spools_;  // microsteps pulled in
};

/// The most that a motion given by samples asks of a motor between them.
struct MotorPeaks {
  double step_rate = 0;     ///< Microsteps a second.
  double speed = 0;         ///< rad/s of the motor.
  double acceleration = 0;  ///< rad/s^2 of the motor.
};

/// Gathers the peaks of a motion from positions at rising times: mean rates between neighbours, and from one
/// of these to the next the mean acceleration.
class MotorWatch {
 public:
  /// For the drive's motors, in the order of its axes.
  explicit MotorWatch(const Drive& drive);
  /// The positions, microsteps, at `time`, s. std::invalid_argument: not one position an axis, or a time not
  /// after the last one.
  void add(double time, std::span<const double> positions);
  /// One an axis; 0 until there are samples enough: two for a rate, three for an acceleration.
  [[nodiscard]] const std::vector<MotorPeaks>& peaks() const { return peaks_; }

 private:
  std::vector<Axis> axes_;
  std::vector<MotorPeaks> peaks_;
  double last_time_ = 0;
  double last_interval_ = 0;            // s; 0 before there are two samples
  std::vector<double> last_positions_;  // empty before the first sample
  std::vector<double> last_rates_;      // microsteps/s
};

}  // namespace flexura
