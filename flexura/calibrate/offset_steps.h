#pragma once

#include <string>
#include <vector>

namespace flexura {

/// State of a loop that reduces one offset to zero.
enum class LoopState {
  holds,  ///< The offset is within the tolerance.
  moves,
  stuck,  ///< The loop will not end; reason() states why.
};

/// Reduces an offset to zero step by step, by one of two methods (docs/calibration-paper.md, "When a loop
/// ends").
class OffsetSteps {
 public:
  /// The paper's method (section 3.4): steps of equal size against the offset's sign. The steps always end if
  /// the tolerance is at least half of the change per step. With a smaller tolerance, they may alternate
  /// forever; take() detects this.
  explicit OffsetSteps(double accepted) : accepted_(accepted) {}
  /// The corrected method: steps in proportion to the offset, at most `largest`. The offset is given as the
  /// motion that would null it according to the model. Steps are halved whenever the offset grows, or changes
  /// its sign without decreasing to half. The steps always end if the true and the modelled effect of a
  /// motion have equal signs.
  OffsetSteps(double accepted, double largest) : accepted_(accepted), largest_(largest) {}

  /// Processes the next measured offset. A positive motion must reduce a positive offset.
  LoopState take(double offset);
  /// Returns the next motion, in the unit of the offset and with the offset's sign. For steps of equal size,
  /// returns 1 or -1.
  [[nodiscard]] double move() const { return move_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  double accepted_, largest_ = 0, move_ = 0, share_ = 1;
  std::vector<double> offsets_;
  std::string reason_;
};

}  // namespace flexura
