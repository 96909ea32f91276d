#pragma once

#include <string>
#include <string_view>

#include "flexura/base/node.h"

namespace flexura {

/// Parses one JSON document into nodes. Throws InputError (source:line:column) on what is not JSON, on a key
/// given twice, and on nesting deeper than 64. Numbers beyond a double are errors; whole numbers stay whole.
[[nodiscard]] Node parse_json(std::string_view text, const std::string& source);

/// The node as JSON: keys in their order, doubles so that they read back exactly, `null` for what JSON lacks.
/// `indent` < 0 gives one line, otherwise that many spaces a level, with what holds only plain values on one
/// line.
[[nodiscard]] std::string write_json(const Node& node, int indent = -1);

}  // namespace flexura
