#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace flexura {

/// Limits of a simulated controller's axes.
struct GrblLimits {
  std::vector<double> rates;          ///< Highest speed of each axis, mm/s.
  std::vector<double> accelerations;  ///< Largest acceleration of each axis, mm/s^2.
  double junction_deviation = 0.01;   ///< Setting $11, mm; larger values allow higher speeds at corners.
};

/// Motion of a simulated controller: a queue of straight lines (blocks), with limited acceleration. The axes
/// do not stop between two blocks if the corner allows a speed above 0. The algorithm is that of Grbl's
/// planner (gnea/grbl, planner.c). The speed at corners is described by Jeon, "Improving Grbl: Cornering
/// Algorithm", 2011. As in Grbl, the pulses of the next 0.06 s are prepared in advance, and neither a new
/// block nor braking changes them (stepper.c: 6 segments, 100 per second). Time advances in ticks.
class GrblMotion {
 public:
  static constexpr double tick = 1e-3;              ///< Length of a tick, s.
  static constexpr std::size_t most_prepared = 60;  ///< Largest number of ticks prepared in advance.

  /// All axes start at 0. `most_blocks`: largest number of blocks in the queue.
  GrblMotion(std::size_t axes, std::size_t most_blocks)
      : most_blocks_(most_blocks),
        position_(axes, 0),
        last_(axes, 0),
        direction_(axes, 0),
        planned_(axes, 0) {}

  /// Adds a straight line from the end of the queue to `target`, mm, at `feed`, mm/s along the line, or
  /// slower. Does nothing for a line without length. Requires that the queue is not full.
  void add(const std::vector<double>& target, double feed, const GrblLimits& limits);
  /// Moves for one tick.
  void step();
  /// Brakes. The axes then remain at rest.
  void brake() { is_braking_ = true; }
  /// Resumes the motion after brake().
  void resume() { is_braking_ = false; }
  /// Stops the motors immediately, deletes the queue and sets the position to `position`, mm.
  void reset(const std::vector<double>& position);
  /// Stops the motors immediately and deletes the queue.
  void reset() { reset(std::vector<double>(position_)); }

  [[nodiscard]] bool is_full() const { return blocks_.size() >= most_blocks_; }
  [[nodiscard]] std::size_t free_blocks() const { return most_blocks_ - blocks_.size(); }
  /// Returns true if nothing moves and nothing is queued.
  [[nodiscard]] bool is_idle() const { return blocks_.empty() && prepared_.empty(); }
  /// Returns true if nothing moves, even if blocks are queued after brake().
  [[nodiscard]] bool is_resting() const {
    return prepared_.empty() && (blocks_.empty() || (is_braking_ && planned_speed_ == 0));
  }
  /// Returns the speed along the line, mm/s.
  [[nodiscard]] double speed() const { return speed_; }
  /// Returns the position, mm.
  [[nodiscard]] const std::vector<double>& position() const { return position_; }
  /// Returns the target position of the last block in the queue, mm.
  [[nodiscard]] const std::vector<double>& last() const { return last_; }
  /// Returns the direction of the current motion, a unit vector, or zeros.
  [[nodiscard]] const std::vector<double>& direction() const { return direction_; }

 private:
  struct Block {
    std::vector<double> from, to, direction;
    double length, speed, acceleration, most_entry, entry = 0;
  };
  // State of the motion after a tick.
  struct Sample {
    std::vector<double> position, direction;
    double speed;
  };
  void plan();
  void prepare();

  std::size_t most_blocks_;
  std::deque<Block> blocks_;
  std::vector<double> position_, last_, direction_;
  double speed_ = 0;
  std::deque<Sample> prepared_;
  std::vector<double> planned_;          // End of what is prepared, mm.
  double done_ = 0, planned_speed_ = 0;  // There, in the first block, mm and mm/s.
  bool is_braking_ = false;
};

}  // namespace flexura
