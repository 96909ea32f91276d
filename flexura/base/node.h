#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {

/// A value as a user wrote it in TOML or JSON, with the position in the source. Nodes connect file formats to
/// the typed tables of fields (table.h): formats parse and print nodes, tables read and write nodes.
struct Node {
  struct Member;
  using Array = std::vector<Node>;
  using Table = std::vector<Member>;  ///< Members in the order written; keys are unique.
  /// A value that no field accepts, such as a date. `name` describes the value in error messages.
  struct Other {
    std::string name;
  };
  /// Content of a node. std::monostate means no value: JSON's null, or a field that is not written.
  using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table, Other>;

  Value value;
  SourcePosition where;  ///< Position of the value. The position of the value's key is Member::where.

  /// Returns the value if it has type T, one of the types in Value; otherwise null. An integer does not count
  /// as a double.
  template <class T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  template <class T>
  [[nodiscard]] T* as() {
    return std::get_if<T>(&value);
  }
  /// Returns whether there is no value. Empty texts, arrays and tables count as values.
  [[nodiscard]] bool empty() const { return std::holds_alternative<std::monostate>(value); }

  /// Returns the value under `key` of a table; null if the key is missing or this node is not a table. The
  /// result points into this node.
  [[nodiscard]] const Node* find(std::string_view key) const;
  [[nodiscard]] Node* find(std::string_view key);

  /// Returns a short text for messages: the value itself, or its kind ("an array", "a table").
  [[nodiscard]] std::string brief() const;
  /// Returns the value as written in a file, arrays in full: "[0.02, 0.02]". For a table returns "its fields'
  /// defaults", because the text describes default values.
  [[nodiscard]] std::string literal() const;
};

/// A key of a table with its value and position.
struct Node::Member {
  std::string key;
  SourcePosition where;
  Node node;
};

/// Makes a node of a number. For a number that is not finite, the node is empty, because JSON cannot
/// represent such numbers.
[[nodiscard]] Node number_node(double value);
/// Makes a node that contains a text.
[[nodiscard]] Node text_node(std::string value);
/// Makes a node that contains an array of texts.
[[nodiscard]] Node texts_node(const std::vector<std::string>& values);

/// Merges `over` into `under`: tables are merged key by key. Any other value in `over` replaces the value in
/// `under`.
void merge(Node& under, Node over);

/// Sets the value at a dotted path, "arm.section.0.length" or "arm.section[0].length", where numbers are
/// indices of arrays. Makes missing tables. Removes the value of this quantity in another unit: removes
/// "length_mm" if "length" is set. Returns "" on success, otherwise an error text: a part of the path is not
/// a table, or an index is outside an array.
[[nodiscard]] std::string set_at_path(Node& root, std::string_view path, Node value);

}  // namespace flexura
