#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

namespace flexura {

/// An enum E with a function `names_of(const E*)`, which returns the names of the enum's values in order. The
/// values are numbered from 0.
template <class E>
concept HasNames = std::is_enum_v<E> && requires(const E* null) { names_of(null); };

/// Returns the name of an enum value, which must be valid.
template <HasNames E>
[[nodiscard]] const std::string& name_of(E value) {
  return names_of(static_cast<const E*>(nullptr))[static_cast<std::size_t>(value)];
}

}  // namespace flexura
