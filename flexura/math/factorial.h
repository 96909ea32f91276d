#pragma once

#include <cstddef>

namespace flexura {

/// Returns n!.
constexpr double factorial(std::size_t n) { return n < 2 ? 1.0 : static_cast<double>(n) * factorial(n - 1); }

}  // namespace flexura
