#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

namespace flexura {

/// An enum with `names_of(const E*)`, a vector of its values' names in the order of their numbers from 0.
template <class E>
concept HasNames = std::is_enum_v<E> && requires(const E* null) { names_of(null); };

/// Of one of its values, which it has.
template <HasNames E>
[[nodiscard]] const std::string& name_of(E value) {
  return names_of(static_cast<const E*>(nullptr))[static_cast<std::size_t>(value)];
}

}  // namespace flexura
