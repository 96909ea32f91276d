#pragma once

#include <cmath>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the rms distance between points at equal shares of both lengths, m.
inline double shape_error(const Shape& shape, const Backbone& truth) {
  const Backbone backbone(shape.arm, shape.state);
  constexpr int count = 100;
  double square = 0;
  for (int i = 0; i <= count; ++i) {
    const double f = static_cast<double>(i) / count;
    square += (backbone.pose(f * backbone.length()).position - truth.pose(f * truth.length()).position)
                  .squaredNorm() /
              (count + 1);
  }
  return std::sqrt(square);
}

}  // namespace flexura
