#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace flexura {

/// Returns 128 bits from the system's secure random source as 32 hexadecimal digits. Throws std::system_error
/// if the random source fails.
std::string new_token();

/// Returns a byte whose bits are set where any two corresponding bytes of two texts of equal length differ.
/// The function always reads all bytes of both texts, so that the time does not depend on their content.
/// `at(text, i)` returns a byte.
template <class At>
unsigned char difference_of(std::string_view a, std::string_view b, At&& at) {
  // volatile prevents the compiler from leaving the loop early.
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (at(a, i) ^ at(b, i)));
  return difference;
}

/// Returns true if two texts are equal, in a time that depends only on their lengths.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace flexura
