#include "flexura/base/problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace flexura {

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  const std::size_t reported = std::min(problems.size(), max_listed_problems);
  for (const Problem& problem : std::span(problems).first(reported)) {
    const std::string column =
        problem.where.column > 1 ? fmt::format("column {}: ", problem.where.column) : "";
    text += (text.empty() ? "" : "; ") + column + problem.what;
  }
  if (problems.size() > reported) text += fmt::format("; and {} more", problems.size() - reported);
  return text;
}

}  // namespace flexura
