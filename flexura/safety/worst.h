#pragma once

#include <cstddef>

#include "flexura/safety/spans.h"

namespace flexura {

/// What a quantity is at its largest, and when.
struct WorstValue {
  double time = 0;  ///< s
  double value = 0;
  /// By how much it may be larger elsewhere, where there was too much to look into; 0: as near as was asked.
  double doubt = 0;
};

/// How near a worst value is to be found.
struct WorstSearch {
  double tolerance = 0;               ///< What the quantity may be above it somewhere,
  double part = 0;                    ///< or this part of the value, what is more.
  std::size_t most_intervals = 2000;  ///< After so many it stands as it is.
};

/// Where a quantity is largest in a span: a value that occurs. Branch and bound: the interval whose upper
/// bound is highest is halved, until no bound is above the largest value in the middles and ends by more than
/// the tolerance.
[[nodiscard]] WorstValue worst_in(const WatchedQuantity& quantity, const Span& span,
                                  const WorstSearch& search);

}  // namespace flexura
