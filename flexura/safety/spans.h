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

/// Returns "0.5 s to 2 s" for a span moved by `shift` s, with six digits or as many as distinguish its ends.
/// Returns "at 2 s" for a single time.
[[nodiscard]] std::string span_text(const Span& span, double shift = 0);

/// Bounds of a quantity.
struct QuantityBounds {
  double low = 0;
  double high = 0;
};

/// A quantity that changes with time, for searches that must not miss anything between two samples.
struct WatchedQuantity {
  std::function<double(double time)> value;
  /// Returns bounds on the value in all of [start, end]. They converge to the value as the interval shrinks.
  std::function<QuantityBounds(double start, double end)> bounds;
};

/// Returns the quantity `value`, with |d value/dt| at most rate(start, end) in all of [start, end].
[[nodiscard]] WatchedQuantity with_rate(std::function<double(double time)> value,
                                        std::function<double(double start, double end)> rate);

/// Quantities, numbered from 0, that are evaluated together because they need the same data at a time.
class WatchedQuantities {
 public:
  virtual ~WatchedQuantities() = default;
  WatchedQuantities() = default;
  WatchedQuantities(const WatchedQuantities&) = delete;
  WatchedQuantities& operator=(const WatchedQuantities&) = delete;

  [[nodiscard]] virtual std::size_t count() const = 0;
  /// Computes the values at `time` of those in `which` (ascending), one each.
  virtual void find_values(double time, std::span<const std::size_t> which,
                           std::span<double> values) const = 0;
  /// Computes bounds like those of WatchedQuantity.
  virtual void find_bounds(const Span& span, std::span<const std::size_t> which,
                           std::span<QuantityBounds> bounds) const = 0;
};

/// Limits of a search.
struct SpanSearch {
  double time = 0;   ///< Undecided intervals longer than this are halved, s.
  double value = 0;  ///< Intervals with an upper bound that exceeds the limit by more are halved too.
  std::size_t most_intervals = 200'000;  ///< Per quantity; after that, samples decide the rest.
  std::size_t most_together = std::numeric_limits<std::size_t>::max();  ///< Of all, shared evenly.
  /// Receives the share of the time that is decided, now and then; false ends the search with the results so
  /// far.
  std::function<bool(double decided)> go_on = {};
};

/// Result of a search.
struct FoundSpans {
  std::vector<Span> spans;  ///< Spans with the quantity above its limit, joined if they touch, in order.
  /// From the first to the last time that only samples decided, because there were too many intervals.
  std::optional<Span> undecided{};
  double sampled_every = 0;  ///< Largest time between samples in `undecided`, s.
};

/// Returns the spans of `whole` in which each of the quantities is above `limit`.
///
/// Misses nothing: an interval is dropped only if its bounds prove it safe, is unsafe if they prove that, and
/// is halved otherwise. One as short as `search` specifies is unsafe if its ends or middle are. It is safe if
/// they are not and its upper bound is that near to the limit. So anything missed is shorter than half of
/// that time, and exceeds the limit by at most that value. The ends of spans are accurate to that time. An
/// interval too short for doubles (`shortest_interval`) is unsafe unless proved safe.
///
/// All intervals of one length come before shorter ones, and all of one length are evaluated or none. So if
/// there are too many, undecided times are evaluated evenly.
[[nodiscard]] std::vector<FoundSpans> spans_above(double limit, const WatchedQuantities& quantities,
                                                  Span whole, const SpanSearch& search);

/// Returns the spans of one quantity.
[[nodiscard]] FoundSpans spans_above(double limit, const WatchedQuantity& quantity, Span whole,
                                     const SpanSearch& search);

/// Length below which no interval is halved, s.
inline constexpr double shortest_interval = 1e-12;

/// Returns true if the span is too short to halve: at late times, doubles are coarser than the shortest
/// interval.
[[nodiscard]] bool is_shortest(const Span& span);

}  // namespace flexura
