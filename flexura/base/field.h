#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/unit.h"

namespace flexura {

struct TableInfo;

/// Range of the numbers that a field accepts, in base units. The default range contains every finite number.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  ///< Whether the number `min` itself is out of range.

  /// Returns whether `value`, in base units, is within the range; false for NaN.
  [[nodiscard]] bool contains(double value) const {
    return (open_min ? value > min : value >= min) && value <= max;
  }
  /// Returns the range as text in the unit of `spelling`: "above 0 m", "at least 0 rad", "from 0 to 1".
  /// Returns "" for an unlimited range.
  [[nodiscard]] std::string text(const UnitSpelling& spelling) const;
};

/// Returns the range of numbers greater than `min`. The bounds of this function and of the next three
/// functions are in base units.
[[nodiscard]] inline NumberRange above(double min) { return {.min = min, .open_min = true}; }
/// Returns the range of numbers greater than or equal to `min`.
[[nodiscard]] inline NumberRange at_least(double min) { return {.min = min}; }
/// Returns the range from `min` to `max`, both included.
[[nodiscard]] inline NumberRange between(double min, double max) { return {.min = min, .max = max}; }
/// Returns the range from `min`, excluded, to `max`, included.
[[nodiscard]] inline NumberRange above_up_to(double min, double max) {
  return {.min = min, .max = max, .open_min = true};
}

/// Smallest and largest number of entries of an array.
struct Count {
  /// Both bounds are included.
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
};

/// Description of one field in a table of fields. The description does not include the member that stores the
/// field's value.
struct Spec {
  /// Meaning of the field, a sentence for error messages, the schema and the reference page.
  std::string meaning = {};
  Unit unit = Unit::none;
  NumberRange range = {};  ///< Range of a number, or of each number of an array.
  Count count = {};        ///< Number of entries of the outermost array.
  bool required = false;
  /// For a table: whether a file may contain only some of its fields, although the reader receives a complete
  /// table.
  bool partial = false;
  bool one_for_all = false;  ///< For an array: whether a file may have one value for all entries.
  /// Effect of omitting the field, if the default value alone does not show the effect.
  std::string default_text = {};
};

/// Type of a field's value.
struct Type {
  /// Kind of value. `choice`: one of the texts in `choices`. `bytes`: binary data, in messages only.
  /// `one_of`: one of several tables.
  enum class Kind { boolean, integer, number, text, bytes, choice, array, table, one_of };
  Kind kind = Kind::number;
  std::vector<std::string> choices = {};  ///< For `choice`: the accepted texts.
  std::shared_ptr<const Type> item = {};  ///< For `array`: type of an entry.
  Count count = {};                       ///< For `array`: number of entries that the C++ type fixes.
  const TableInfo* table = nullptr;       ///< For `table`: the table's fields.
  /// For `one_of`: the tables, identified by the key "kind".
  std::vector<const TableInfo*> alternatives = {};
};

/// Data of a field that a schema or a reference page shows.
struct FieldInfo {
  std::string name;  ///< The key without a unit's suffix.
  Type type;
  Spec spec;
  std::string default_text;  ///< Default value as written in a file; "" if the field is required.
};

/// The old and the new name of a field, both without a unit's suffix.
struct RenamedField {
  std::string old_name;
  std::string name;
};

/// Description of a table of fields, independent of the struct that stores the values.
struct TableInfo {
  std::string name;  ///< Name in messages and schemas; for the tables of a one_of, the text of "kind".
  std::string meaning = {};
  std::vector<FieldInfo> fields;
  /// Fields that had another name in older versions. A document with an old name causes an error that states
  /// the new name.
  std::vector<RenamedField> renamed = {};

  /// Returns the field with this name, without a unit's suffix; null if the table has no such field.
  [[nodiscard]] const FieldInfo* find(std::string_view field_name) const;
};

}  // namespace flexura
