#pragma once

#include <string>
#include <string_view>

namespace flexura {

/// Throws InputError if a key has more than 32 dotted parts or brackets are nested more than 32 deep. The
/// parser toml++ 3.3 limits the depth of nested values, but not of dotted keys. The parser frees its tables
/// recursively, so a key with a million parts would overflow the stack.
void check_toml_depth(std::string_view text, const std::string& source);

}  // namespace flexura
