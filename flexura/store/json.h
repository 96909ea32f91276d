#pragma once

#include <string>
#include <string_view>

#include "flexura/base/node.h"

namespace flexura {

/// Parses one JSON document into nodes. Throws InputError (source:line:column) for invalid JSON, repeated
/// keys, nesting deeper than 64, and numbers beyond the range of a double. Integers remain integers.
[[nodiscard]] Node parse_json(std::string_view text, const std::string& source);

/// Returns the node as JSON. Keys keep their order, and doubles keep their exact values. Values that do not
/// exist in JSON become `null`. With `indent` < 0, the result is one line; otherwise `indent` is the number
/// of spaces per level. Containers that have only plain values are on one line.
[[nodiscard]] std::string write_json(const Node& node, int indent = -1);

}  // namespace flexura
