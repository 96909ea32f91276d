#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace flexura {

/// The middle one of some values by size, of an even number the upper middle one. Reorders them. Not empty.
template <typename Value>
[[nodiscard]] Value median(std::span<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace flexura
