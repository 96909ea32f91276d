#include "flexura/safety/spans.h"

#include <algorithm>

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

std::vector<Span> spans_above(double limit, const WatchedQuantity& quantity, Span whole, double resolution) {
  std::vector<Span> found;
  std::vector<Span> open{whole};  // a stack: the earliest interval is on top, so spans are found in order
  while (!open.empty()) {
    const Span span = open.back();
    open.pop_back();
    const double middle = (span.start + span.end) / 2;
    const double value = quantity.value(middle);
    const double change = quantity.rate(span.start, span.end) * (span.end - span.start) / 2;
    if (value + change <= limit) continue;
    if (value - change > limit) {
      add(span, found);
    } else if (span.end - span.start <= resolution) {
      if (std::max({value, quantity.value(span.start), quantity.value(span.end)}) > limit) add(span, found);
    } else {
      open.push_back({middle, span.end});
      open.push_back({span.start, middle});
    }
  }
  return found;
}

}  // namespace flexura
