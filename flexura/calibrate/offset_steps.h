#pragma once

#include <string>
#include <vector>

namespace flexura {

/// Whether a loop that nulls one offset goes on.
enum class LoopState {
  holds,  ///< The offset is accepted, or nothing finer can be commanded.
  moves,
  stuck,  ///< It will not end: the reason says why.
};

/// The paper's way to null an offset (section 3.4): a step of one size, to the side that the offset's sign
/// says, until it is accepted. Ends from everywhere if what is accepted is at least half of what one step
/// changes; with less it may go back and forth for ever (docs/calibration-paper.md), which is noticed.
class EqualSteps {
 public:
  EqualSteps(double step, double accepted) : step_(step), accepted_(accepted) {}

  /// Takes the next offset. A move lowers a positive offset by a positive amount of `step`.
  LoopState take(double offset);
  /// What to move by, in the step's unit, signed as the offset.
  [[nodiscard]] double move() const { return move_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  double step_, accepted_, move_ = 0;
  std::vector<double> offsets_;
  std::string reason_;
};

/// Steps in proportion to the offset, which shrink: what would null the offset by the behaviour that is
/// believed, and by half as much from when it jumped over, or grew. With a true behaviour of k times the
/// believed one this ends for every k > 0, and needs no halving up to 1.5 (docs/calibration-paper.md).
class ShrinkingSteps {
 public:
  /// `accepted`: in the motion's unit, as the offsets are; `largest`: of a step.
  ShrinkingSteps(double accepted, double largest) : accepted_(accepted), largest_(largest) {}

  /// Takes the next offset, expressed as the motion that would null it.
  LoopState take(double offset);
  [[nodiscard]] double move() const { return move_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] double share() const { return share_; }

 private:
  double accepted_, largest_, move_ = 0, share_ = 1;
  std::vector<double> offsets_;
  std::string reason_;
};

}  // namespace flexura
