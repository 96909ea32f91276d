// Any bytes as an expression must give a value at every time, finite or not, or an ExpressionError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "flexura/kinematics/expression.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const flexura::Expression expression(text);
    for (const double t : {0.0, 0.5, 1.0}) {
      const double first = expression.value(t, 1.0, 1);
      const double again = expression.value(t, 1.0, 1);
      if (first != again && !(std::isnan(first) && std::isnan(again))) std::abort();
    }
  } catch (const flexura::ExpressionError& error) {
    if (error.position() > text.size()) std::abort();
  }
  return 0;
}
