#pragma once

#include <cstddef>

#include "flexura/safety/spans.h"

namespace flexura {

/// Largest value of a quantity and its time.
struct WorstValue {
  double time = 0;  ///< In s.
  double value = 0;
  /// By how much the true maximum may exceed `value`, if the search ran out of intervals; 0: as precise as
  /// required.
  double uncertainty = 0;
};

/// Required precision of a worst value.
struct WorstSearch {
  double tolerance = 0;  ///< By how much the quantity may exceed it somewhere.
  double part = 0;       ///< Share of the value that it may exceed it by; the larger of both counts.
  std::size_t most_intervals = 2000;  ///< Most intervals of a search.
};

/// Returns the largest value of a quantity in a span, which occurs. Branch and bound: halves the interval
/// with the highest upper bound. Ends when no bound exceeds the largest value of the middles and ends by more
/// than the tolerance.
[[nodiscard]] WorstValue worst_in(const WatchedQuantity& quantity, const Span& span,
                                  const WorstSearch& search);

}  // namespace flexura
