#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace flexura {

/// Returns the median of `values`; for an even number of values, the upper median. Reorders the values.
/// `values` must not be empty.
template <typename Value>
[[nodiscard]] Value median(std::span<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace flexura
