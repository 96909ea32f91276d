#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {

/// A value as a user wrote it, in TOML or JSON, and where. The common ground between file formats and the
/// typed tables of fields (table.h): formats make and print nodes, tables read and write them.
struct Node {
  struct Member;
  using Array = std::vector<Node>;
  using Table = std::vector<Member>;  ///< In the order written; keys are unique.
  /// A value no field takes, such as a date; `name` says what it is, for the error.
  struct Other {
    std::string name;
  };
  /// std::monostate stands for nothing: JSON's null, and fields that are not written.
  using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table, Other>;

  Value value;
  SourcePosition where;  ///< Of the value; the key before it has its own place (Member::where).

  /// The value if it is a T, one of the types of Value; else null. An integer is no double.
  template <class T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  template <class T>
  [[nodiscard]] T* as() {
    return std::get_if<T>(&value);
  }
  /// Nothing is written here. Empty texts, arrays and tables are something.
  [[nodiscard]] bool empty() const { return std::holds_alternative<std::monostate>(value); }

  /// The value under `key` of a table; null when there is none or this is no table. Points into this node.
  [[nodiscard]] const Node* find(std::string_view key) const;
  [[nodiscard]] Node* find(std::string_view key);

  /// Short text for messages: the value itself, or what kind of value it is ("an array", "a table").
  [[nodiscard]] std::string brief() const;
  /// The value as one writes it, arrays in full: "[0.02, 0.02]". A table is "its fields' defaults", as this
  /// serves the description of defaults.
  [[nodiscard]] std::string literal() const;
};

/// What a table has under a key, and where the key stands in the text.
struct Node::Member {
  std::string key;
  SourcePosition where;
  Node node;
};

/// A number that a program writes. One that is not finite is written as nothing: JSON has no word for it.
[[nodiscard]] Node number_node(double value);
/// A text that a program writes.
[[nodiscard]] Node text_node(std::string value);
/// An array of texts.
[[nodiscard]] Node texts_node(const std::vector<std::string>& values);

/// Lays `over` upon `under`: tables are merged key by key, anything else is replaced.
void merge(Node& under, Node over);

/// Sets the value at a dotted path ("arm.section.0.length" or "arm.section[0].length"; numbers index arrays),
/// making tables on the way. A value of the same name in another unit ("length_mm" beside "length") is taken
/// out. Returns an error text ("" when done): a part that is no table, an index outside an array.
[[nodiscard]] std::string set_at_path(Node& root, std::string_view path, Node value);

}  // namespace flexura
