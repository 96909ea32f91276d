#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {

/// A value as written by a user in TOML or JSON, with its position. It is the common form between file
/// formats and the typed tables of fields (table.h): formats parse and print nodes, tables read and write
/// them.
struct Node {
  struct Member;
  using Array = std::vector<Node>;
  using Table = std::vector<Member>;  ///< In the order written; keys are unique.
  /// A value that no field accepts, such as a date; `name` describes it for the error.
  struct Other {
    std::string name;
  };
  /// std::monostate stands for nothing: JSON's null, and fields that are not written.
  using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table, Other>;

  Value value;
  SourcePosition where;  ///< Position of the value; the key before it has its own position (Member::where).

  /// Returns the value if it is a T, one of the types of Value; otherwise null. An integer is not a double.
  template <class T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  template <class T>
  [[nodiscard]] T* as() {
    return std::get_if<T>(&value);
  }
  /// Returns whether there is no value. Empty texts, arrays and tables are values.
  [[nodiscard]] bool empty() const { return std::holds_alternative<std::monostate>(value); }

  /// Returns the value under `key` of a table; null if missing or if this is not a table. Points into this
  /// node.
  [[nodiscard]] const Node* find(std::string_view key) const;
  [[nodiscard]] Node* find(std::string_view key);

  /// Returns a short text for messages: the value itself, or its kind ("an array", "a table").
  [[nodiscard]] std::string brief() const;
  /// Returns the value as written in a file, arrays in full: "[0.02, 0.02]". A table is "its fields'
  /// defaults", as this serves the description of defaults.
  [[nodiscard]] std::string literal() const;
};

/// A key of a table with its value and position.
struct Node::Member {
  std::string key;
  SourcePosition where;
  Node node;
};

/// Makes a node of a number; one that is not finite gives an empty node, as JSON cannot represent it.
[[nodiscard]] Node number_node(double value);
/// Makes a node of a text.
[[nodiscard]] Node text_node(std::string value);
/// Makes a node of an array of texts.
[[nodiscard]] Node texts_node(const std::vector<std::string>& values);

/// Merges `over` into `under`: tables key by key; anything else is replaced.
void merge(Node& under, Node over);

/// Sets the value at a dotted path ("arm.section.0.length" or "arm.section[0].length"; numbers index arrays),
/// and makes missing tables. Removes a value of the same name in another unit ("length_mm" beside "length").
/// Returns an error text ("" on success): a part is not a table, or an index is outside an array.
[[nodiscard]] std::string set_at_path(Node& root, std::string_view path, Node value);

}  // namespace flexura
