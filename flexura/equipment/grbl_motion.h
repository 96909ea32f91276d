#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace flexura {

/// Limits of a simulated controller's axes.
struct GrblLimits {
  std::vector<double> rates;          ///< Highest speed of each axis, mm/s.
  std::vector<double> accelerations;  ///< mm/s^2
  double junction_deviation = 0.01;   ///< Setting $11, mm: how fast a corner is passed.
};

/// Motion of a simulated controller: straight blocks in a queue, with limited acceleration, and without a
/// stop between blocks where the corner allows it. This is the planner of Grbl (gnea/grbl, planner.c; the
/// corner's speed is described by S. K. Jeon, "Improving Grbl: Cornering Algorithm", 2011). As there, the
/// next 0.06 s of pulses are prepared in advance, and neither a new block nor braking changes them
/// (stepper.c, 6 segments at 100 a second). Time advances in ticks.
class GrblMotion {
 public:
  static constexpr double tick = 1e-3;              ///< s
  static constexpr std::size_t most_prepared = 60;  ///< Ticks.

  /// All axes start at 0. `most_blocks`: places of the queue.
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
  /// Brakes, and stays at rest.
  void brake() { is_braking_ = true; }
  /// Goes on after brake().
  void resume() { is_braking_ = false; }
  /// Stops at once, forgets the queue and goes to `position`, mm, without motion.
  void reset(const std::vector<double>& position);
  /// Stops at once and forgets the queue.
  void reset() { reset(std::vector<double>(position_)); }

  [[nodiscard]] bool is_full() const { return blocks_.size() >= most_blocks_; }
  [[nodiscard]] std::size_t free_blocks() const { return most_blocks_ - blocks_.size(); }
  /// Returns true if nothing moves and nothing is queued.
  [[nodiscard]] bool is_idle() const { return blocks_.empty() && prepared_.empty(); }
  /// Returns true if nothing moves: also after brake().
  [[nodiscard]] bool is_resting() const {
    return prepared_.empty() && (blocks_.empty() || (is_braking_ && planned_speed_ == 0));
  }
  /// Returns the speed along the line, mm/s.
  [[nodiscard]] double speed() const { return speed_; }
  /// Returns the position, mm.
  [[nodiscard]] const std::vector<double>& position() const { return position_; }
  /// Returns the end of the queue, mm.
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
