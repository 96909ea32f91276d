#pragma once

#include <cstddef>

#include "flexura/safety/spans.h"

namespace flexura {

/// Largest value of a quantity and its time.
struct WorstValue {
  double time = 0;  ///< Time, s.
  double value = 0;
  /// If the search reached its limit on intervals: amount by which the true maximum may exceed `value`.
  /// Otherwise 0: `value` is as precise as required.
  double uncertainty = 0;
};

/// Required precision of a worst value, and limit of the search.
struct WorstSearch {
  double tolerance = 0;  ///< Absolute tolerance: amount by which the true maximum may exceed the result.
  double part = 0;       ///< Tolerance as a fraction of the result. The larger of both tolerances applies.
  std::size_t most_intervals = 2000;  ///< Largest number of intervals.
};

/// Returns the largest value of a quantity in a span, and a time at which the quantity has this value. The
/// method is branch and bound: it repeatedly halves the interval with the largest upper bound. The method
/// ends when no upper bound exceeds the largest value found so far by more than the tolerance.
[[nodiscard]] WorstValue worst_in(const WatchedQuantity& quantity, const Span& span,
                                  const WorstSearch& search);

}  // namespace flexura
