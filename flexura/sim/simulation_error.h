#pragma once

#include <stdexcept>

namespace flexura {

/// What a simulated arm does cannot be computed from here on: it comes to no rest, or its motion blows up.
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace flexura
