#include "flexura/safety/spans.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace flexura {
namespace {

enum class Verdict { safe, above, open };

double sampled(const WatchedQuantity& quantity, const Span& span) {
  return std::max(
      {quantity.value(span.start), quantity.value((span.start + span.end) / 2), quantity.value(span.end)});
}

Verdict judged(double limit, const WatchedQuantity& quantity, const Span& span, const SpanSearch& search) {
  const QuantityBounds bounds = quantity.bounds(span.start, span.end);
  if (bounds.high <= limit) return Verdict::safe;
  if (bounds.low > limit) return Verdict::above;
  const double length = span.end - span.start;
  if (length <= search.time && bounds.high <= limit + search.value)
    return sampled(quantity, span) > limit ? Verdict::above : Verdict::safe;
  // Late times are less fine than the shortest interval.
  const bool is_shortest = length <= std::max(shortest_interval, 1e-15 * span.end);
  return is_shortest ? Verdict::above : Verdict::open;
}

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

}  // namespace

std::string span_text(const Span& span, double shift) {
  const double start = shift + span.start;
  const double end = shift + span.end;
  if (start == end) return fmt::format("at {:.6g} s", start);
  // 17 digits tell any two doubles apart.
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

FoundSpans spans_above(double limit, const WatchedQuantity& quantity, Span whole, const SpanSearch& search) {
  std::vector<Span> above;
  std::vector<Span> open{whole};
  std::vector<Span> shorter;
  std::size_t examined = 0;
  // By length, from the longest on; `open` is in the order of time.
  for (; !open.empty() && examined < search.most_intervals; open.swap(shorter)) {
    shorter.clear();
    for (const Span& span : open) {
      if (++examined > search.most_intervals) {
        shorter.push_back(span);
        continue;
      }
      const Verdict verdict = judged(limit, quantity, span, search);
      if (verdict == Verdict::above) above.push_back(span);
      if (verdict != Verdict::open) continue;
      const double middle = (span.start + span.end) / 2;
      shorter.push_back({span.start, middle});
      shorter.push_back({middle, span.end});
    }
  }
  FoundSpans found;
  for (const Span& span : open) {
    if (sampled(quantity, span) > limit) above.push_back(span);
    found.sampled_every = std::max(found.sampled_every, (span.end - span.start) / 2);
  }
  if (!open.empty()) found.undecided = {open.front().start, open.back().end};
  found.spans = joined(std::move(above));
  return found;
}

}  // namespace flexura
