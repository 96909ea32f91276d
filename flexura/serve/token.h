#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace flexura {

/// 128 bits from the system's source of secrets, as 32 hexadecimal digits. std::system_error when it has
/// none.
std::string new_token();

/// How two texts differ: all bits that do in any byte, gathered by looking at each byte of both, wherever the
/// first difference is. `at(text, i)` gives a byte of one. Of texts of the same length.
template <class At>
unsigned char difference_of(std::string_view a, std::string_view b, At&& at) {
  // volatile: no reason for a compiler to leave the loop early.
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (at(a, i) ^ at(b, i)));
  return difference;
}

/// Whether two texts are equal, in a time that depends on their lengths only.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace flexura
