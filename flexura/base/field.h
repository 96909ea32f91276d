#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/unit.h"

namespace flexura {

struct TableInfo;

/// Range of a field's numbers, in base units. The default contains every finite number.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  ///< Excludes min itself.

  /// `value` in base units, like the bounds. No range contains NaN.
  [[nodiscard]] bool contains(double value) const {
    return (open_min ? value > min : value >= min) && value <= max;
  }
  /// Returns "above 0 m", "at least 0 rad", "from 0 to 1", in the unit of a spelling; "" for an unlimited
  /// range.
  [[nodiscard]] std::string text(const UnitSpelling& spelling) const;
};

/// Returns a range by its bounds, in base units, like the following functions: open where "above" is in the
/// name, closed otherwise.
[[nodiscard]] inline NumberRange above(double min) { return {.min = min, .open_min = true}; }
/// Returns the range from `min` on.
[[nodiscard]] inline NumberRange at_least(double min) { return {.min = min}; }
/// Returns the range from `min` to `max`, both included.
[[nodiscard]] inline NumberRange between(double min, double max) { return {.min = min, .max = max}; }
/// Returns the range above `min`, up to `max`.
[[nodiscard]] inline NumberRange above_up_to(double min, double max) {
  return {.min = min, .max = max, .open_min = true};
}

/// Number of entries of an array.
struct Count {
  /// Both are included.
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
};

/// Description of one field in a table of fields, apart from its member.
struct Spec {
  std::string meaning = {};  ///< A sentence for errors, the schema and the reference.
  Unit unit = Unit::none;
  NumberRange range = {};  ///< Range of a number, or of each number of an array.
  Count count = {};        ///< Number of entries of the outermost array.
  bool required = false;
  bool partial = false;           ///< For a table: a file may contain parts of it; the reader gets the whole.
  bool one_for_all = false;       ///< For an array: may be written as one value for all entries.
  std::string default_text = {};  ///< Effect of omitting it, if the default's value does not show that.
};

/// Type of a field's value.
struct Type {
  /// choice: one of the texts `choices`; bytes: binary data, in messages only.
  enum class Kind { boolean, integer, number, text, bytes, choice, array, table, one_of };
  Kind kind = Kind::number;
  std::vector<std::string> choices = {};            ///< choice
  std::shared_ptr<const Type> item = {};            ///< array
  Count count = {};                                 ///< array of a size fixed by its type
  const TableInfo* table = nullptr;                 ///< table
  std::vector<const TableInfo*> alternatives = {};  ///< one_of: identified by the key "kind"
};

/// A field without its member: everything for a schema or a reference page.
struct FieldInfo {
  std::string name;  ///< The key without a unit's suffix.
  Type type;
  Spec spec;
  std::string default_text;  ///< Default as written in a file; "" if required.
};

/// The old and the new name of a field, both without a unit's suffix.
struct RenamedField {
  std::string old_name;
  std::string name;
};

/// A table of fields without its struct.
struct TableInfo {
  std::string name;  ///< Name in messages and schemas; for the tables of a one_of, the text of "kind".
  std::string meaning = {};
  std::vector<FieldInfo> fields;
  /// Fields that had another name in older versions. A document with the old name gets an error with the new
  /// one.
  std::vector<RenamedField> renamed = {};

  /// Returns the field of this name, without a unit's suffix; null if missing.
  [[nodiscard]] const FieldInfo* find(std::string_view field_name) const;
};

}  // namespace flexura
