#pragma once

#include <string>

#include "flexura/base/field.h"
#include "flexura/base/node.h"

namespace flexura {

/// The JSON Schema (draft 7) of a document described by `info`, which editors use to complete and check
/// files. A quantity has one property a spelling of its unit, each with the range in that unit.
[[nodiscard]] Node json_schema(const TableInfo& info);

/// The same as a Markdown reference: a section a table, a row a field.
[[nodiscard]] std::string markdown_reference(const TableInfo& info);

}  // namespace flexura
