#pragma once

#include <concepts>

#include "flexura/base/table.h"
#include "flexura/model/arm_config.h"

namespace flexura {

/// Adds the fields of a shape to the table of a struct derived from ShapeConfig.
template <std::derived_from<ShapeConfig> S>
[[nodiscard]] Table<S> with_shape_fields(Table<S> table) {
  const TableInfo& shape = fields_of(static_cast<const ShapeConfig*>(nullptr)).info();
  const auto add = [&]<typename M>(const char* name, M ShapeConfig::* member) {
    table.field(name, static_cast<M S::*>(member), shape.find(name)->spec);
  };
  add("cord_angles", &ShapeConfig::cord_angles);
  add("archings", &ShapeConfig::archings);
  add("bends", &ShapeConfig::bends);
  add("stretches", &ShapeConfig::stretches);
  return table;
}

}  // namespace flexura
