#include "flexura/safety/spans.h"

#include <algorithm>
#include <utility>

namespace flexura {
namespace {

void add(Span span, std::vector<Span>& spans) {
  if (!spans.empty() && spans.back().end >= span.start) {
    spans.back().end = std::max(spans.back().end, span.end);
  } else {
    spans.push_back(span);
  }
}

}  // namespace

WatchedQuantity with_rate(std::function<double(double time)> value,
                          std::function<double(double start, double end)> rate) {
  auto bounds = [value, rate = std::move(rate)](double start, double end) {
    const double middle = value((start + end) / 2);
    const double change = rate(start, end) * (end - start) / 2;
    return QuantityBounds{middle - change, middle + change};
  };
  return {std::move(value), std::move(bounds)};
}

std::vector<Span> spans_above(double limit, const WatchedQuantity& quantity, Span whole, double resolution) {
  std::vector<Span> found;
  std::vector<Span> open{whole};  // a stack: the earliest interval is on top, so spans are found in order
  while (!open.empty()) {
    const Span span = open.back();
    open.pop_back();
    const double middle = (span.start + span.end) / 2;
    const QuantityBounds bounds = quantity.bounds(span.start, span.end);
    if (bounds.high <= limit) continue;
    if (bounds.low > limit) {
      add(span, found);
    } else if (span.end - span.start <= resolution) {
      const double most =
          std::max({quantity.value(span.start), quantity.value(middle), quantity.value(span.end)});
      if (most > limit) add(span, found);
    } else {
      open.push_back({middle, span.end});
      open.push_back({span.start, middle});
    }
  }
  return found;
}

}  // namespace flexura
