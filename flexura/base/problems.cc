#include "flexura/base/problems.h"

#include <fmt/format.h>

namespace flexura {

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    const std::string column =
        problem.where.column > 1 ? fmt::format("column {}: ", problem.where.column) : "";
    text += (text.empty() ? "" : "; ") + column + problem.what;
  }
  return text;
}

}  // namespace flexura
