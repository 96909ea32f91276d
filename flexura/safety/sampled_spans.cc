#include "flexura/safety/sampled_spans.h"

#include <limits>

namespace flexura {

WorstValue worst_in(const std::function<double(double time)>& value, const Span& span) {
  constexpr int samples = 200;
  WorstValue worst{span.start, -std::numeric_limits<double>::infinity()};
  for (int k = 0; k <= samples; ++k) {
    const double time = k == samples ? span.end : span.start + (span.end - span.start) * k / samples;
    const double now = value(time);
    if (now > worst.value) worst = {time, now};
  }
  return worst;
}

void SampledSpans::sample(std::size_t step, double time, double value, bool is_bad) {
  if (!is_bad) return;
  if (spans_.empty() || last_step_ + 1 < step) spans_.push_back({{time, time}, {time, value}});
  last_step_ = step;
  Found& found = spans_.back();
  found.span.end = time;
  if (value > found.worst.value) found.worst = {time, value};
}

}  // namespace flexura
