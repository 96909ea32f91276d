#pragma once

#include <span>
#include <string_view>

namespace flexura {

/// Base unit of a number in a file. The program uses SI units; in a file, a key's suffix selects another
/// unit.
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

/// A way to write a quantity in a file. A value v under the key NAME + suffix is v * factor in base units.
struct UnitSpelling {
  std::string_view suffix;  ///< "" for the base unit, "_deg", "_pi", "_mm", ...
  double factor = 1.0;      ///< Value, in base units, of the number 1 in this unit.
  std::string_view symbol;  ///< "rad", "deg", "x pi rad", "mm", ...
};

/// Returns the spellings of a quantity, the base unit first.
[[nodiscard]] std::span<const UnitSpelling> spellings(Unit unit);

/// Returns the base unit's symbol ("m", "rad"), "" for Unit::none.
[[nodiscard]] inline std::string_view symbol(Unit unit) { return spellings(unit).front().symbol; }

/// Returns the suffixes of all units. Error messages use these suffixes to distinguish a wrong unit from a
/// misspelt name.
[[nodiscard]] std::span<const std::string_view> all_unit_suffixes();

/// Returns a key without its unit's suffix: "length" for "length_mm" and for "length".
[[nodiscard]] std::string_view without_unit(std::string_view key);

}  // namespace flexura
