#pragma once

#include <span>
#include <string_view>

namespace flexura {

/// What a number in a file measures. Inside the program everything is SI; a key's suffix says another unit.
enum class Unit {
  none,
  metre,
  metre_per_second,
  metre_per_second_squared,
  second,
  radian,
  radian_per_second,
  radian_per_second_squared
};

/// A way to write a quantity: a value under the key NAME + suffix counts `factor` base units.
struct UnitSpelling {
  std::string_view suffix;  ///< "" for the base unit, "_deg", "_pi", "_mm", ...
  double factor = 1.0;      ///< Base units for a written 1.
  std::string_view symbol;  ///< "rad", "deg", "x pi rad", "mm", ...
};

/// The spellings of a unit, base unit first.
[[nodiscard]] std::span<const UnitSpelling> spellings(Unit unit);

/// The base unit's symbol ("m", "rad"), "" for none.
[[nodiscard]] inline std::string_view symbol(Unit unit) { return spellings(unit).front().symbol; }

/// Every suffix that any unit has, to tell a wrong unit from a misspelt name.
[[nodiscard]] std::span<const std::string_view> all_unit_suffixes();

/// A key without its unit's suffix: "length" of "length_mm" and of "length".
[[nodiscard]] std::string_view without_unit(std::string_view key);

}  // namespace flexura
