#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

namespace flexura {

/// An enum with `names_of(const E*)`: the names of its values, in order of their numbers from 0.
template <class E>
concept HasNames = std::is_enum_v<E> && requires(const E* null) { names_of(null); };

/// Returns the name of a valid value.
template <HasNames E>
[[nodiscard]] const std::string& name_of(E value) {
  return names_of(static_cast<const E*>(nullptr))[static_cast<std::size_t>(value)];
}

}  // namespace flexura
