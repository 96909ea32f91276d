#pragma once

#include <stdexcept>

namespace flexura {

/// Thrown if the motion of a simulated arm cannot be computed any further: it has no equilibrium, or its
/// motion diverges.
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace flexura
