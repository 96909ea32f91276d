#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "flexura/calibrate/etalon_counts.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

/// The paper's calibration with the cylinder as it is printed (section 3.4), its slips included: pixels are
/// counted, steps are all alike, positioning looks at what does not depend on it, the test of the vertical
/// calibration asks what was just made so, and the zoom goes the wrong way (docs/calibration-paper.md). Where
/// a loop goes on for ever, or runs away, it says so.
class EtalonPaperLoop {
 public:
  explicit EtalonPaperLoop(LookLoop& loop) : loop_(loop) {}
  [[nodiscard]] LookLoop::Trouble run();

 private:
  using Trouble = LookLoop::Trouble;
  struct Procedure;
  [[nodiscard]] Trouble look(std::size_t i);
  /// One of the printed procedures: a step to the side that the sign says until the offset is accepted.
  [[nodiscard]] Trouble follow(std::size_t i, const Procedure& what);
  /// Whether two axes were seen, of which the outer one was turned out of the picture.
  [[nodiscard]] Trouble turn_away(std::size_t i, bool& is_turned);
  [[nodiscard]] Trouble horizontal(std::size_t i);
  [[nodiscard]] Trouble vertical(std::size_t i);
  [[nodiscard]] Trouble zoom();

  LookLoop& loop_;
  std::array<EtalonCounts, 2> counts_;
  std::array<int, 2> turned_away_ = {0, 0};
};

}  // namespace flexura
