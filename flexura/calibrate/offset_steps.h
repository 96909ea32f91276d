#pragma once

#include <string>
#include <vector>

namespace flexura {

/// Whether a loop that nulls one offset goes on.
enum class LoopState {
  holds,  ///< The offset is accepted.
  moves,
  stuck,  ///< It will not end: the reason says why.
};

/// Nulls an offset step by step, in one of two ways (docs/calibration-paper.md, "When a loop ends").
class OffsetSteps {
 public:
  /// As printed (section 3.4): steps of one size, to the side that the offset's sign says. They end from
  /// everywhere if what is accepted is at least half of what one step changes; with less they may go back and
  /// forth for ever, which is noticed.
  explicit OffsetSteps(double accepted) : accepted_(accepted) {}
  /// Corrected: steps in proportion to the offset, given as the motion that would null it by the behaviour
  /// that is believed, `largest` at most; half as large from when the offset jumped over, or grew. They end
  /// where the true behaviour has the believed one's sign.
  OffsetSteps(double accepted, double largest) : accepted_(accepted), largest_(largest) {}

  /// Takes the next offset. A move lowers a positive offset by a positive amount.
  LoopState take(double offset);
  /// What to move by, signed as the offset: in its unit, or 1 in size where steps are all alike.
  [[nodiscard]] double move() const { return move_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  double accepted_, largest_ = 0, move_ = 0, share_ = 1;
  std::vector<double> offsets_;
  std::string reason_;
};

}  // namespace flexura
