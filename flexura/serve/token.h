#pragma once

#include <string>
#include <string_view>

namespace flexura {

/// 128 bits from the system's source of secrets, as 32 hexadecimal digits. std::system_error when it has
/// none.
std::string new_token();

/// Whether two texts are equal, in a time that depends on their lengths only.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace flexura
