#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flexura {

/// From when to when, s.
struct Span {
  double start = 0;
  double end = 0;
};

/// "0.5 s to 2 s" of a span moved by `shift` s, in six digits or as many as tell its ends apart; "at 2 s" of
/// one time.
[[nodiscard]] std::string span_text(const Span& span, double shift = 0);

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

/// Quantities, numbered from 0, that are looked at together because what they need to know of a time is the
/// same.
class WatchedQuantities {
 public:
  virtual ~WatchedQuantities() = default;
  WatchedQuantities() = default;
  WatchedQuantities(const WatchedQuantities&) = delete;
  WatchedQuantities& operator=(const WatchedQuantities&) = delete;

  [[nodiscard]] virtual std::size_t count() const = 0;
  /// The values at `time` of those in `which` (ascending), one each.
  virtual void find_values(double time, std::span<const std::size_t> which,
                           std::span<double> values) const = 0;
  /// Bounds as those of WatchedQuantity.
  virtual void find_bounds(const Span& span, std::span<const std::size_t> which,
                           std::span<QuantityBounds> bounds) const = 0;
};

/// When an interval is looked into no further.
struct SpanSearch {
  double time = 0;                       ///< s: intervals that are undecided and longer are halved,
  double value = 0;                      ///< and so are those whose upper bound is above the limit by more.
  std::size_t most_intervals = 200'000;  ///< Of one quantity: after so many, samples decide what is open.
  std::size_t most_together = std::numeric_limits<std::size_t>::max();  ///< Of all, shared evenly.
  /// Told which share of the time is decided, now and then; false ends the search, with what it has found.
  std::function<bool(double decided)> go_on = {};
};

/// What a search found.
struct FoundSpans {
  std::vector<Span> spans;  ///< Where the quantity is above its limit, joined where they touch, in order.
  /// From the first to the last time that only samples decided, because there was too much to look into.
  std::optional<Span> undecided{};
  double sampled_every = 0;  ///< s, in there at most.
};

/// The spans of `whole` in which each of the quantities is above `limit`.
///
/// Nothing slips through: an interval is let go only when its bounds prove it safe, is taken whole when they
/// prove it unsafe, and is halved otherwise. One as short as `search` says is unsafe when its ends or middle
/// are, and safe when they are not and its upper bound is as near to the limit. So what is missed, if
/// anything, is shorter than half of that time, and above the limit by no more than that value; and the ends
/// of spans are right to that time. What time cannot resolve (`shortest_interval`) is unsafe unless proved
/// safe.
///
/// All intervals of one length come before shorter ones, and all of one length are looked into or none: what
/// is open when there are too many is looked into evenly.
[[nodiscard]] std::vector<FoundSpans> spans_above(double limit, const WatchedQuantities& quantities,
                                                  Span whole, const SpanSearch& search);

/// Those of one quantity.
[[nodiscard]] FoundSpans spans_above(double limit, const WatchedQuantity& quantity, Span whole,
                                     const SpanSearch& search);

/// No interval is halved below this, s.
inline constexpr double shortest_interval = 1e-12;

/// Whether the span is as short as time can be told apart: late times are less fine than the shortest
/// interval.
[[nodiscard]] bool is_shortest(const Span& span);

}  // namespace flexura
