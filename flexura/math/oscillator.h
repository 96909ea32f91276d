#pragma once

#include <Eigen/Core>

namespace flexura {

/// Returns the free motion of z'' + 2 damping frequency z' + frequency^2 z = 0 over `duration` s. The result
/// is the matrix that maps the initial (z, z') to the final (z, z'). `frequency`: rad/s, > 0. A damping ratio
/// of 1 or more counts as 0.999.
[[nodiscard]] Eigen::Matrix2d oscillation(double frequency, double damping, double duration);

}  // namespace flexura
