#pragma once

#include <string>

#include "flexura/port/outcome.h"

namespace flexura {

// Returns the fault's text, or "".
template <class T>
std::string fault_of(const Outcome<T>& outcome) {
  const auto fault = outcome.fault();
  return fault ? text(*fault) : "";
}

}  // namespace flexura
