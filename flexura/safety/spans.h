#pragma once

#include <functional>
#include <vector>

namespace flexura {

/// From when to when, s.
struct Span {
  double start = 0;
  double end = 0;
};

/// Between what a quantity stays.
struct QuantityBounds {
  double low = 0;
  double high = 0;
};

/// A quantity that changes with time, for questions that must not miss what happens between two samples.
struct WatchedQuantity {
  std::function<double(double time)> value;
  /// Bounds on the value that hold everywhere in [start, end], and come down to it as the two come together.
  std::function<QuantityBounds(double start, double end)> bounds;
};

/// The quantity `value` whose |d value/dt| is nowhere in [start, end] above rate(start, end).
[[nodiscard]] WatchedQuantity with_rate(std::function<double(double time)> value,
                                        std::function<double(double start, double end)> rate);

/// The spans of `whole` in which the quantity is above `limit`, joined where they touch, in order.
///
/// Nothing slips through: an interval is let go only when its bounds prove it safe, is taken whole when they
/// prove it unsafe, and is halved otherwise, down to `resolution` s, where its ends and middle decide. So
/// what is missed, if anything, is shorter than half the resolution, and the ends of spans are right to it.
[[nodiscard]] std::vector<Span> spans_above(double limit, const WatchedQuantity& quantity, Span whole,
                                            double resolution);

}  // namespace flexura
