#include "flexura/safety/spans.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace flexura {
namespace {

std::vector<Span> joined(std::vector<Span> spans) {
  std::ranges::sort(spans, {}, &Span::start);
  std::vector<Span> result;
  for (const Span& span : spans) {
    if (!result.empty() && result.back().end >= span.start) {
      result.back().end = std::max(result.back().end, span.end);
    } else {
      result.push_back(span);
    }
  }
  return result;
}

class OneQuantity : public WatchedQuantities {
 public:
  explicit OneQuantity(const WatchedQuantity& quantity) : quantity_(quantity) {}

  [[nodiscard]] std::size_t count() const override { return 1; }
  void find_values(double time, std::span<const std::size_t> /*which*/,
                   std::span<double> values) const override {
    for (double& value : values) value = quantity_.value(time);
  }
  void find_bounds(const Span& span, std::span<const std::size_t> /*which*/,
                   std::span<QuantityBounds> bounds) const override {
    for (QuantityBounds& one : bounds) one = quantity_.bounds(span.start, span.end);
  }

 private:
  const WatchedQuantity& quantity_;
};

// Halves intervals, each with the quantities that are undecided in it, starting from the longest.
class Halving {
 public:
  Halving(double limit, const WatchedQuantities& quantities, const SpanSearch& search)
      : limit_(limit),
        quantities_(quantities),
        search_(search),
        found_(quantities.count()),
        looked_(quantities.count()),
        open_in_(quantities.count(), 1),
        left_(quantities.count()) {}

  std::vector<FoundSpans> find(const Span& whole) && {
    Level level;
    level.which.resize(quantities_.count());
    std::iota(level.which.begin(), level.which.end(), std::size_t{0});
    level.intervals.push_back({whole, 0, level.which.size()});
    level.open = level.which.size();
    for (double count = 1; !level.which.empty(); count *= 2) {
      leave_what_is_too_much();
      std::ranges::fill(open_in_, std::size_t{0});
      const double all = count * static_cast<double>(quantities_.count());
      const double decided = 1 - static_cast<double>(level.open) / all;
      Level halves;
      for (const Interval& interval : level.intervals) {
        if (!goes_on(interval.count, decided)) return std::move(*this).result();
        look_into(interval.span, std::span(level.which).subspan(interval.first, interval.count), halves);
      }
      level = std::move(halves);
    }
    return std::move(*this).result();
  }

 private:
  // The quantities that are undecided in an interval are a range of the level's list, from `first`. Two
  // halves share theirs.
  struct Interval {
    Span span;
    std::size_t first = 0;
    std::size_t count = 0;
  };
  struct Level {
    std::vector<Interval> intervals;  // In the order of time.
    std::vector<std::size_t> which;
    std::size_t open = 0;  // Total of undecided quantities over the intervals.
  };

  // Leaves quantities with too many undecided intervals to samples. Each quantity has its own limit, and an
  // equal share of the common limit's rest.
  void leave_what_is_too_much() {
    const auto open = static_cast<std::size_t>(std::ranges::count_if(open_in_, [](auto n) { return n > 0; }));
    const std::size_t share = open == 0 ? 0 : (search_.most_together - looked_together_) / open;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      left_[i] = open_in_[i] > share || looked_[i] + open_in_[i] > search_.most_intervals;
      if (!left_[i]) looked_[i] += open_in_[i], looked_together_ += open_in_[i];
    }
  }

  bool goes_on(std::size_t looks, double decided) {
    constexpr std::size_t seldom = 500;
    looks_since_ += looks;
    if (looks_since_ < seldom || !search_.go_on) return true;
    looks_since_ = 0;
    return search_.go_on(decided);
  }

  void look_into(const Span& span, std::span<const std::size_t> open, Level& halves) {
    sampled_.clear();
    looked_at_.clear();
    for (const std::size_t i : open) (left_[i] ? sampled_ : looked_at_).push_back(i);
    if (!sampled_.empty()) leave(span);
    if (!looked_at_.empty()) judge(span, halves);
  }

  // Decides an interval by samples.
  void leave(const Span& span) {
    sample(span, sampled_);
    for (std::size_t k = 0; k < sampled_.size(); ++k) {
      FoundSpans& found = found_[sampled_[k]];
      if (worst_[k] > limit_) found.spans.push_back(span);
      if (!found.undecided) found.undecided = span;
      found.undecided->end = span.end;
      found.sampled_every = (span.end - span.start) / 2;
    }
  }

  void judge(const Span& span, Level& halves) {
    bounds_.resize(looked_at_.size());
    quantities_.find_bounds(span, looked_at_, bounds_);
    const bool is_short = span.end - span.start <= search_.time;
    if (is_short) sample(span, looked_at_);
    const std::size_t first = halves.which.size();
    for (std::size_t k = 0; k < looked_at_.size(); ++k) {
      const std::size_t i = looked_at_[k];
      if (bounds_[k].high <= limit_) continue;
      const bool is_above = bounds_[k].low > limit_ || (is_short && worst_[k] > limit_);
      if (!is_above && is_short && bounds_[k].high <= limit_ + search_.value) continue;
      if (is_above || is_shortest(span)) {
        found_[i].spans.push_back(span);
      } else {
        halves.which.push_back(i);
        open_in_[i] += 2;
      }
    }
    const std::size_t count = halves.which.size() - first;
    if (count == 0) return;
    const double middle = (span.start + span.end) / 2;
    halves.intervals.push_back({{span.start, middle}, first, count});
    halves.intervals.push_back({{middle, span.end}, first, count});
    halves.open += 2 * count;
  }

  // Computes the largest of their values at the ends and in the middle.
  void sample(const Span& span, std::span<const std::size_t> which) {
    values_.resize(which.size());
    worst_.assign(which.size(), -std::numeric_limits<double>::infinity());
    for (const double time : {span.start, (span.start + span.end) / 2, span.end}) {
      quantities_.find_values(time, which, values_);
      for (std::size_t k = 0; k < values_.size(); ++k) worst_[k] = std::max(worst_[k], values_[k]);
    }
  }

  std::vector<FoundSpans> result() && {
    for (FoundSpans& found : found_) found.spans = joined(std::move(found.spans));
    return std::move(found_);
  }

  double limit_;
  const WatchedQuantities& quantities_;
  const SpanSearch& search_;
  std::vector<FoundSpans> found_;
  std::vector<std::size_t> looked_;   // Intervals evaluated per quantity.
  std::vector<std::size_t> open_in_;  // Undecided intervals of this length per quantity.
  std::vector<bool> left_;            // Left to samples.
  std::size_t looked_together_ = 0;
  std::size_t looks_since_ = 0;
  std::vector<std::size_t> looked_at_, sampled_;  // In the current interval.
  std::vector<QuantityBounds> bounds_;
  std::vector<double> values_, worst_;
};

}  // namespace

std::string span_text(const Span& span, double shift) {
  const double start = shift + span.start;
  const double end = shift + span.end;
  if (start == end) return fmt::format("at {:.6g} s", start);
  // 17 digits distinguish any two doubles.
  for (int digits = 6;; ++digits) {
    const std::string from = fmt::format("{:.{}g}", start, digits);
    const std::string to = fmt::format("{:.{}g}", end, digits);
    if (from != to || digits == 17) return fmt::format("{} s to {} s", from, to);
  }
}

WatchedQuantity with_rate(std::function<double(double time)> value,
                          std::function<double(double start, double end)> rate) {
  auto bounds = [value, rate = std::move(rate)](double start, double end) {
    const double middle = value((start + end) / 2);
    const double change = rate(start, end) * (end - start) / 2;
    return QuantityBounds{middle - change, middle + change};
  };
  return {std::move(value), std::move(bounds)};
}

std::vector<FoundSpans> spans_above(double limit, const WatchedQuantities& quantities, Span whole,
                                    const SpanSearch& search) {
  return Halving(limit, quantities, search).find(whole);
}

FoundSpans spans_above(double limit, const WatchedQuantity& quantity, Span whole, const SpanSearch& search) {
  return std::move(spans_above(limit, OneQuantity(quantity), whole, search).front());
}

bool is_shortest(const Span& span) {
  return span.end - span.start <= std::max(shortest_interval, 1e-15 * span.end);
}

}  // namespace flexura
