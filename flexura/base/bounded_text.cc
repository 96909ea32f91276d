#include "flexura/base/bounded_text.h"

#include <fmt/format.h>

namespace flexura {

std::string bounded_text(double value, double most, int digits) {
  return value <= most ? fmt::format("{:.{}g}", value, digits) : fmt::format("more than {:.6g}", most);
}

}  // namespace flexura
