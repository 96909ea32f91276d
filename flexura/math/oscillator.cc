#include "flexura/math/oscillator.h"

#include <algorithm>
#include <cmath>

namespace flexura {

Eigen::Matrix2d oscillation(double frequency, double damping, double duration) {
  constexpr double most_damping = 0.999;
  const double zeta = std::clamp(damping, 0.0, most_damping);
  const double rate = frequency * std::sqrt(1 - zeta * zeta), decay = zeta * frequency;
  const double c = std::cos(rate * duration), s = std::sin(rate * duration);
  Eigen::Matrix2d motion;
  motion << c + decay / rate * s, s / rate, -frequency * frequency / rate * s, c - decay / rate * s;
  return std::exp(-decay * duration) * motion;
}

}  // namespace flexura
