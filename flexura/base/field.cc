#include "flexura/base/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace flexura {

std::string NumberRange::text(const UnitSpelling& spelling) const {
  const auto shown = [&](double bound) {
    return fmt::format("{:.12g}{}{}", bound / spelling.factor, spelling.symbol.empty() ? "" : " ",
                       spelling.symbol);
  };
  const bool has_min = std::isfinite(min);
  const bool has_max = std::isfinite(max);
  if (has_min && has_max) {
    return open_min ? fmt::format("above {} and at most {}", shown(min), shown(max))
                    : fmt::format("from {} to {}", shown(min), shown(max));
  }
  if (has_min) return fmt::format("{} {}", open_min ? "above" : "at least", shown(min));
  if (has_max) return fmt::format("at most {}", shown(max));
  return {};
}

const FieldInfo* TableInfo::find(std::string_view field_name) const {
  const auto found = std::ranges::find(fields, field_name, &FieldInfo::name);
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace flexura
