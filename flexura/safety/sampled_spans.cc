#include "flexura/safety/sampled_spans.h"

namespace flexura {

void SampledSpans::add(std::size_t step, const Span& span, double value) {
  if (spans_.empty() || last_step_ + 1 < step) spans_.push_back({span, {span.end, value}});
  last_step_ = step;
  Found& found = spans_.back();
  found.span.end = span.end;
  if (value > found.worst.value) found.worst = {span.end, value};
}

}  // namespace flexura
