#pragma once

#include <numbers>

namespace flexura {

/// A degree, rad: 25 * degree is an angle in the program, angle / degree is in degrees.
inline constexpr double degree = std::numbers::pi / 180;

}  // namespace flexura
