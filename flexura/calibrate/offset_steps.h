#pragma once

#include <string>
#include <vector>

namespace flexura {

/// State of a loop that nulls one offset.
enum class LoopState {
  holds,  ///< The offset is within the tolerance.
  moves,
  stuck,  ///< The loop will not end; see the reason.
};

/// Nulls an offset step by step, in one of two ways (docs/calibration-paper.md, "When a loop ends").
class OffsetSteps {
 public:
  /// As printed (section 3.4): steps of equal size against the offset's sign. They end from everywhere if the
  /// tolerance is at least half of the change per step. With less they may alternate forever, which is
  /// detected.
  explicit OffsetSteps(double accepted) : accepted_(accepted) {}
  /// Corrected: steps in proportion to the offset, given as the motion that would null it in the model, at
  /// most `largest`. They are halved whenever the offset changes sign without halving, or grows. They end if
  /// the true behaviour has the sign of the modelled one.
  OffsetSteps(double accepted, double largest) : accepted_(accepted), largest_(largest) {}

  /// Takes the next offset. A move lowers a positive offset by a positive amount.
  LoopState take(double offset);
  /// Returns the next motion with the sign of the offset: in its unit, or +-1 for steps of equal size.
  [[nodiscard]] double move() const { return move_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  double accepted_, largest_ = 0, move_ = 0, share_ = 1;
  std::vector<double> offsets_;
  std::string reason_;
};

}  // namespace flexura
