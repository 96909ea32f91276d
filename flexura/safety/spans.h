#pragma once

#include <functional>
#include <vector>

namespace flexura {

/// From when to when, s.
struct Span {
  double start = 0;
  double end = 0;
};

/// A quantity that changes with time, for questions that must not miss what happens between two samples.
struct WatchedQuantity {
  std::function<double(double time)> value;
  /// A bound on |d value/dt| that holds everywhere in [start, end].
  std::function<double(double start, double end)> rate;
};

/// The spans of [start, end] in which the quantity is above `limit`, joined where they touch.
///
/// Nothing slips through: an interval is let go only when its middle value and its rate bound prove it safe,
/// is taken whole when they prove it unsafe, and is halved otherwise, down to `resolution` s, where its ends
/// and middle decide. So what is missed, if anything, exceeds the limit by less than the rate times half the
/// resolution.
[[nodiscard]] std::vector<Span> spans_above(double limit, const WatchedQuantity& quantity, Span whole,
                                            double resolution);

}  // namespace flexura
