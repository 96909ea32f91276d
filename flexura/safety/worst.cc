#include "flexura/safety/worst.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <vector>

namespace flexura {
namespace {

struct Bounded {
  Span span;
  double high = 0;

  friend bool operator<(const Bounded& a, const Bounded& b) { return a.high < b.high; }
};

}  // namespace

WorstValue worst_in(const WatchedQuantity& quantity, const Span& span, const WorstSearch& search) {
  WorstValue worst{span.start, quantity.value(span.start)};
  std::priority_queue<Bounded> open;
  std::size_t looked = 0;
  const auto look_at = [&](double time) {
    const double value = quantity.value(time);
    if (value > worst.value) worst.time = time, worst.value = value;
  };
  const auto is_higher = [&](double high) {
    return high > worst.value + std::max(search.tolerance, search.part * std::abs(worst.value));
  };
  const auto add = [&](const Span& part) {
    ++looked;
    const double high = quantity.bounds(part.start, part.end).high;
    if (is_higher(high)) open.push({part, high});
  };
  look_at(span.end);
  for (add(span); !open.empty() && is_higher(open.top().high);) {
    if (looked >= search.most_intervals) {
      worst.uncertainty = open.top().high - worst.value;
      break;
    }
    const Span part = open.top().span;
    open.pop();
    const double middle = (part.start + part.end) / 2;
    look_at(middle);
    if (is_shortest(part)) continue;
    add({part.start, middle});
    add({middle, part.end});
  }
  return worst;
}

}  // namespace flexura
