#pragma once

#include <concepts>

#include "flexura/base/table.h"
#include "flexura/model/arm_config.h"

namespace flexura {

/// The table of a struct that is a shape, and may be more, with the fields of a shape added.
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
