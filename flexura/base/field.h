#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/unit.h"

namespace flexura {

struct TableInfo;

/// The numbers a field takes, in base units. The default takes every finite number.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  ///< min itself is out.

  /// `value` in base units, as the bounds are. No range holds NaN.
  [[nodiscard]] bool contains(double value) const {
    return (open_min ? value > min : value >= min) && value <= max;
  }
  /// "above 0 m", "at least 0 rad", "from 0 to 1"; in the unit of a spelling. "" when everything is in.
  [[nodiscard]] std::string text(const UnitSpelling& spelling) const;
};

/// A range by its bounds, in base units, as those that follow: open where "above" says so, closed otherwise.
[[nodiscard]] inline NumberRange above(double min) { return {.min = min, .open_min = true}; }
/// From `min` on.
[[nodiscard]] inline NumberRange at_least(double min) { return {.min = min}; }
/// From `min` to `max`, both within.
[[nodiscard]] inline NumberRange between(double min, double max) { return {.min = min, .max = max}; }
/// Above `min`, up to `max`.
[[nodiscard]] inline NumberRange above_up_to(double min, double max) {
  return {.min = min, .max = max, .open_min = true};
}

/// How many entries an array takes.
struct Count {
  /// Both numbers are in.
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
};

/// What the table of fields says about one field, beside the member it fills.
struct Spec {
  std::string meaning = {};  ///< A sentence for people: in errors, the schema and the reference.
  Unit unit = Unit::none;
  NumberRange range = {};  ///< Of a number, or of each number of an array.
  Count count = {};        ///< Of the outermost array.
  bool required = false;
  bool partial = false;           ///< A table of which a file may write parts; the reader is given the whole.
  bool one_for_all = false;       ///< An array may be written as one value, meant for every entry.
  std::string default_text = {};  ///< What leaving it out means, where the default's value does not say it.
};

/// The shape of a field's value.
struct Type {
  /// choice: one of the texts `choices`; bytes: binary data, in messages alone.
  enum class Kind { boolean, integer, number, text, bytes, choice, array, table, one_of };
  Kind kind = Kind::number;
  std::vector<std::string> choices = {};            ///< choice
  std::shared_ptr<const Type> item = {};            ///< array
  Count count = {};                                 ///< array of a size fixed by its type
  const TableInfo* table = nullptr;                 ///< table
  std::vector<const TableInfo*> alternatives = {};  ///< one_of: told apart by the key "kind"
};

/// A field without its member: all that a schema or a reference page needs.
struct FieldInfo {
  std::string name;  ///< The key without a unit's suffix.
  Type type;
  Spec spec;
  std::string default_text;  ///< As it would be written; "" when required.
};

/// The old and the new name of a field, both without a unit's suffix.
struct RenamedField {
  std::string old_name;
  std::string name;
};

/// A table of fields without its struct.
struct TableInfo {
  std::string name;  ///< In messages and schemas; of a one_of's tables the text under "kind".
  std::string meaning = {};
  std::vector<FieldInfo> fields;
  /// Fields that had another name in older versions. A document with the old name gets an error with the new
  /// one.
  std::vector<RenamedField> renamed = {};

  /// The field of this name, without a unit's suffix; null when there is none.
  [[nodiscard]] const FieldInfo* find(std::string_view field_name) const;
};

}  // namespace flexura
