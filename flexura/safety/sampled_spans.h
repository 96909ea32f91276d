#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "flexura/safety/spans.h"

namespace flexura {

/// What a quantity is at its largest, and when.
struct WorstValue {
  double time = 0;  ///< s
  double value = 0;
};

/// Where the value is largest in a span, of its ends and what lies evenly between.
[[nodiscard]] WorstValue worst_in(const std::function<double(double time)>& value, const Span& span);

/// Spans that grow with samples: a sample stands for the time up to the next.
class SampledSpans {
 public:
  struct Found {
    Span span;
    WorstValue worst;
  };

  /// Takes the sample at a step, after those of all earlier steps.
  void sample(std::size_t step, double time, double value, bool is_bad);
  [[nodiscard]] const std::vector<Found>& spans() const { return spans_; }

 private:
  std::vector<Found> spans_;
  std::size_t last_step_ = 0;
};

}  // namespace flexura
