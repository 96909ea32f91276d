#pragma once

#include <string>
#include <string_view>

#include "flexura/base/node.h"

namespace flexura {

/// Parses one JSON document into nodes. Throws InputError (source:line:column) on invalid JSON, on a repeated
/// key, and on nesting deeper than 64. Numbers beyond the range of a double are errors; integers stay
/// integers.
[[nodiscard]] Node parse_json(std::string_view text, const std::string& source);

/// Returns the node as JSON: keys in their order, doubles with their exact values, and `null` for values that
/// JSON lacks. `indent` < 0 gives one line; otherwise `indent` is the number of spaces per level. Containers
/// of only plain values are on one line.
[[nodiscard]] std::string write_json(const Node& node, int indent = -1);

}  // namespace flexura
