#pragma once

#include <numbers>

namespace flexura {

/// One degree in radians. 25 * degree is 25 degrees in rad; angle / degree converts an angle in rad to
/// degrees.
inline constexpr double degree = std::numbers::pi / 180;

}  // namespace flexura
