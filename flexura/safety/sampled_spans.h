#pragma once

#include <cstddef>
#include <vector>

#include "flexura/safety/spans.h"
#include "flexura/safety/worst.h"

namespace flexura {

/// Spans that grow with samples: those of steps that follow each other are one.
class SampledSpans {
 public:
  struct Found {
    Span span;
    WorstValue worst;
  };

  /// Takes what is too much at a step, after all earlier steps: the value for the time `span`, as of its end.
  void add(std::size_t step, const Span& span, double value);
  [[nodiscard]] const std::vector<Found>& spans() const { return spans_; }

 private:
  std::vector<Found> spans_;
  std::size_t last_step_ = 0;
};

}  // namespace flexura
