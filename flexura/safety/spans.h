#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flexura {

/// A time interval, s.
struct Span {
  double start = 0;
  double end = 0;
};

/// Returns the text of a span shifted by `shift`, s: "0.5 s to 2 s", or "at 2 s" for a single time. Times
/// have six digits, or as many as needed to distinguish the ends.
[[nodiscard]] std::string span_text(const Span& span, double shift = 0);

/// Lower and upper bound of a quantity.
struct QuantityBounds {
  double low = 0;
  double high = 0;
};

/// A function of time with bounds over intervals. With the bounds, searches miss nothing between two samples.
struct WatchedQuantity {
  std::function<double(double time)> value;
  /// Returns bounds on the value during all of [start, end], s. The bounds converge to the value as the
  /// interval shrinks.
  std::function<QuantityBounds(double start, double end)> bounds;
};

/// Returns the quantity `value`, whose |d value/dt| is at most rate(start, end) during all of [start, end].
[[nodiscard]] WatchedQuantity with_rate(std::function<double(double time)> value,
                                        std::function<double(double start, double end)> rate);

/// Quantities, numbered from 0, that are evaluated together because they depend on the same data.
class WatchedQuantities {
 public:
  virtual ~WatchedQuantities() = default;
  WatchedQuantities() = default;
  WatchedQuantities(const WatchedQuantities&) = delete;
  WatchedQuantities& operator=(const WatchedQuantities&) = delete;

  [[nodiscard]] virtual std::size_t count() const = 0;
  /// Computes the values at `time` of the quantities with the numbers `which` (ascending).
  virtual void find_values(double time, std::span<const std::size_t> which,
                           std::span<double> values) const = 0;
  /// Computes bounds on the quantities with the numbers `which` during `span`, as WatchedQuantity::bounds
  /// does.
  virtual void find_bounds(const Span& span, std::span<const std::size_t> which,
                           std::span<QuantityBounds> bounds) const = 0;
};

/// Parameters of a search.
struct SpanSearch {
  double time = 0;  ///< Undecided intervals longer than this time are halved, s.
  /// Undecided intervals whose upper bound exceeds the limit by more than this value are halved too.
  double value = 0;
  /// Largest number of intervals per quantity. Samples decide the remaining intervals.
  std::size_t most_intervals = 200'000;
  /// Largest total number of intervals of all quantities, distributed evenly among them.
  std::size_t most_together = std::numeric_limits<std::size_t>::max();
  /// Function that is called repeatedly with the decided fraction of the time. If the function returns false,
  /// the search ends with the results so far.
  std::function<bool(double decided)> go_on = {};
};

/// Result of a search.
struct FoundSpans {
  std::vector<Span>
      spans;  ///< Spans in which the quantity is above its limit, in order; touching spans are joined.
  /// Span from the first to the last time for which only samples decided, because the number of intervals
  /// reached its limit.
  std::optional<Span> undecided{};
  double sampled_every = 0;  ///< Largest time between samples in `undecided`, s.
};

/// Returns the spans of `whole` in which each of the quantities is above `limit`.
///
/// The bounds of an interval may prove that the quantity is below the limit or above it; otherwise the
/// interval is halved. An undecided interval no longer than search.time counts as above the limit if the
/// quantity is above the limit at its ends or middle. Any other undecided interval counts as below the limit
/// if its upper bound exceeds the limit by at most search.value. Hence a missed violation is shorter than
/// half of search.time and exceeds the limit by at most search.value. The ends of spans are accurate to
/// search.time. An interval that is too short to halve (`shortest_interval`) counts as above the limit if its
/// upper bound is above the limit.
///
/// Intervals are processed by decreasing length, and either all or none of the intervals of one length are
/// evaluated. If the number of intervals reaches its limit, undecided times are therefore sampled evenly.
[[nodiscard]] std::vector<FoundSpans> spans_above(double limit, const WatchedQuantities& quantities,
                                                  Span whole, const SpanSearch& search);

/// Returns the spans of `whole` in which one quantity is above `limit`.
[[nodiscard]] FoundSpans spans_above(double limit, const WatchedQuantity& quantity, Span whole,
                                     const SpanSearch& search);

/// Intervals shorter than this time are not halved, s.
inline constexpr double shortest_interval = 1e-12;

/// Returns whether a span is too short to halve. At late times, the spacing of doubles is larger than
/// `shortest_interval`.
[[nodiscard]] bool is_shortest(const Span& span);

}  // namespace flexura
