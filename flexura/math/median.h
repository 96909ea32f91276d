#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace flexura {

/// Returns the median of some values; of an even number the upper one. Reorders them. Must not be empty.
template <typename Value>
[[nodiscard]] Value median(std::span<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace flexura
