#pragma once

#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "python/bindings/convert.h"

namespace flexura::python {

/// Returns a table as TOML text, with one line for each key of the table and inline tables below.
[[nodiscard]] std::string toml_text(const Node::Table& table);

/// Returns changes {"arm.section.0.length": 0.3} as texts PATH=VALUE of the option --set.
[[nodiscard]] std::vector<std::string> set_texts(const py::dict& sets);

}  // namespace flexura::python
