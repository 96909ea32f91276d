#pragma once

#include <string>

#include "flexura/base/field.h"
#include "flexura/base/node.h"

namespace flexura {

/// Returns the JSON Schema (draft 7) of a document described by `info`. Editors use the schema to complete
/// and check files. A quantity has one property per unit suffix, each with the range in the suffix's unit.
[[nodiscard]] Node json_schema(const TableInfo& info);

/// Returns a Markdown reference of the document: one section per table, one row per field. If a table occurs
/// again, the reference links to the table's first section. Fields that all alternatives share, or that form
/// another table, are described only once.
[[nodiscard]] std::string markdown_reference(const TableInfo& info);

}  // namespace flexura
