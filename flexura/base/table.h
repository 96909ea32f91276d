#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/base/field.h"
#include "flexura/base/fields.h"
#include "flexura/base/names.h"
#include "flexura/base/node.h"
#include "flexura/base/reader.h"

namespace flexura {

/// Reads, writes and describes values of type T. The template is specialised for each type. The codec of a
/// struct uses its table of fields; the codec of an enum uses the names of its values.
template <class T>
struct Codec;

/// The functions of a Codec in a form that does not depend on T: values are given by their addresses.
struct ValueCodec {
  bool (*read)(const Node& node, const Spec& spec, Reader& reader, void* value);
  Node (*write)(const void* value);
  Type (*type)();
};

/// The functions of Codec<T>.
template <class T>
inline constexpr ValueCodec codec_of = {
    [](const Node& node, const Spec& spec, Reader& reader, void* value) {
      return Codec<T>::read(node, spec, reader, *static_cast<T*>(value));
    },
    [](const void* value) { return Codec<T>::write(*static_cast<const T*>(value)); },
    [] { return Codec<T>::type(); }};

/// The part of `Table` that does not depend on S, compiled once. Parameters `value` are addresses of an S.
class AnyTable {
 public:
  [[nodiscard]] const TableInfo& info() const { return info_; }

 protected:
  AnyTable(std::string name, std::string meaning);

  /// Adds a field. `offset` is the position of its member in the struct, bytes. `default_value` is the
  /// address of this member in a default-constructed struct.
  void add(std::string name, std::size_t offset, const ValueCodec& codec, const void* default_value,
           Spec spec);
  void add_renamed(std::string old_name, std::string name);
  void add_check(std::function<void(const void*, Reader&)> rule) { checks_.push_back(std::move(rule)); }
  bool read_at(const Node& node, Reader& reader, void* value, std::string_view tag) const;
  [[nodiscard]] Node write_at(const void* value) const;

 private:
  struct Binding {
    std::size_t offset;
    const ValueCodec* codec;
  };
  TableInfo info_;
  std::vector<Binding> bindings_;
  std::vector<std::function<void(const void*, Reader&)>> checks_;
};

/// The table of fields of a struct: name, unit, range, default and meaning of each member, defined once. The
/// typed reader, the error messages, the writer, the schema and the reference page use this table.
///
/// A struct S has a table if its namespace has a function `const Table<S>& fields_of(const S*)`. Default
/// values are the members of a default-constructed S.
template <class S>
class Table : public AnyTable {
 public:
  /// `name`: the text of the key "kind" if the table is one of several alternatives. `meaning`: a sentence
  /// for the reference page.
  Table(std::string name, std::string meaning) : AnyTable(std::move(name), std::move(meaning)) {}

  /// Adds a field whose value is stored in `member`, a member of S or of a base of S.
  template <class M, class Base>
    requires std::derived_from<S, Base>
  Table& field(std::string name, M Base::* member, Spec spec) {
    const S& value = defaults();
    const M* field = &(value.*member);
    const auto offset = reinterpret_cast<const char*>(field) - reinterpret_cast<const char*>(&value);
    add(std::move(name), static_cast<std::size_t>(offset), codec_of<M>, field, std::move(spec));
    return *this;
  }

  /// Declares an old name of a field. A document with the old name, with any unit's suffix, causes an error
  /// with the new `name`: "is now called ...". Throws std::logic_error unless the field `name` was added
  /// before.
  Table& renamed(std::string old_name, std::string name) {
    add_renamed(std::move(old_name), std::move(name));
    return *this;
  }

  /// Adds a check across fields, which reports its problems to the reader. The check runs only if every field
  /// was read without a problem.
  template <std::invocable<const S&, Reader&> Rule>
  Table& check(Rule rule) {
    add_check([rule](const void* value, Reader& reader) { rule(*static_cast<const S*>(value), reader); });
    return *this;
  }

  /// Fills `value` from a node that must be a table; returns false if a problem was reported. `tag` is an
  /// additional accepted key.
  bool read(const Node& node, Reader& reader, S& value, std::string_view tag = {}) const {
    return read_at(node, reader, &value, tag);
  }

  /// Writes every field that has a value, in the table's order and in base units.
  [[nodiscard]] Node write(const S& value) const { return write_at(&value); }

 private:
  static const S& defaults() {
    static const S value{};
    return value;
  }
};

/// Reads a whole document as an S. Throws InputError with all problems found, if any.
template <class S>
[[nodiscard]] S read_as(const Node& document) {
  Reader reader;
  S value{};
  const Reader::Scope scope(reader, std::string_view{}, document.where);
  fields_of(static_cast<const S*>(nullptr)).read(document, reader, value);
  reader.throw_if_any();
  return value;
}

template <class T>
concept HasFields = requires(const T* null) { fields_of(null); };

template <>
struct Codec<double> {
  static Type type() { return {.kind = Type::Kind::number}; }
  static bool read(const Node& node, const Spec& spec, Reader& reader, double& value) {
    return reader.number(node, spec, value);
  }
  /// Omits an infinite value, which means that there is no bound.
  static Node write(double value) { return std::isfinite(value) ? Node{value, {}} : Node{}; }
};

template <>
struct Codec<std::int64_t> {
  static Type type() { return {.kind = Type::Kind::integer}; }
  static bool read(const Node& node, const Spec& spec, Reader& reader, std::int64_t& value) {
    return reader.integer(node, spec, value);
  }
  static Node write(std::int64_t value) { return {value, {}}; }
};

template <>
struct Codec<bool> {
  static Type type() { return {.kind = Type::Kind::boolean}; }
  static bool read(const Node& node, const Spec&, Reader& reader, bool& value) {
    const bool* written = node.as<bool>();
    if (written == nullptr) return reader.unexpected(node, "true or false"), false;
    value = *written;
    return true;
  }
  static Node write(bool value) { return {value, {}}; }
};

template <>
struct Codec<std::string> {
  static Type type() { return {.kind = Type::Kind::text}; }
  static bool read(const Node& node, const Spec&, Reader& reader, std::string& value) {
    return reader.text(node, value);
  }
  static Node write(const std::string& value) { return {value, {}}; }
};

template <HasNames E>
struct Codec<E> {
  static const std::vector<std::string>& names() { return names_of(static_cast<const E*>(nullptr)); }
  static Type type() { return {.kind = Type::Kind::choice, .choices = names()}; }
  static bool read(const Node& node, const Spec&, Reader& reader, E& value) {
    const auto* written = node.as<std::string>();
    for (std::size_t i = 0; written != nullptr && i < names().size(); ++i) {
      if (names()[i] == *written) return value = static_cast<E>(i), true;
    }
    return reader.unexpected_choice(node, names()), false;
  }
  static Node write(E value) { return {name_of(value), {}}; }
};

/// An empty optional is not written.
template <class T>
struct Codec<std::optional<T>> {
  static Type type() { return Codec<T>::type(); }
  static bool read(const Node& node, const Spec& spec, Reader& reader, std::optional<T>& value) {
    T inner{};
    if (!Codec<T>::read(node, spec, reader, inner)) return false;
    value = std::move(inner);
    return true;
  }
  static Node write(const std::optional<T>& value) { return value ? Codec<T>::write(*value) : Node{}; }
};

namespace codec_detail {

// Returns the kind of the entries of an array of T.
template <class T>
Type::Kind kind_of() {
  static const Type::Kind kind = Codec<T>::type().kind;
  return kind;
}

// Reads the entries of an array into values[0..]; every invalid entry is reported.
template <class T, class Values>
bool read_entries(const Node::Array& entries, const Spec& spec, Reader& reader, Values& values) {
  bool all_read = true;
  Spec entry_spec = spec;
  entry_spec.count = {};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Reader::Scope scope(reader, i, entries[i].where);
    all_read = Codec<T>::read(entries[i], entry_spec, reader, values[i]) && all_read;
  }
  return all_read;
}

template <class Values>
Node write_entries(const Values& values) {
  Node::Array entries;
  for (const auto& value : values) entries.push_back(Codec<std::decay_t<decltype(value)>>::write(value));
  return {std::move(entries), {}};
}

}  // namespace codec_detail

template <class T>
struct Codec<std::vector<T>> {
  static Type type() {
    return {.kind = Type::Kind::array, .item = std::make_shared<const Type>(Codec<T>::type())};
  }
  static bool read(const Node& node, const Spec& spec, Reader& reader, std::vector<T>& value) {
    if (spec.one_for_all && node.as<Node::Array>() == nullptr) {
      value.assign(1, T{});
      return Codec<T>::read(node, spec, reader, value.front());
    }
    const Node::Array* entries = reader.array(node, spec.count, codec_detail::kind_of<T>());
    if (entries == nullptr) return false;
    value.assign(entries->size(), T{});
    return codec_detail::read_entries<T>(*entries, spec, reader, value);
  }
  static Node write(const std::vector<T>& value) { return codec_detail::write_entries(value); }
};

template <class T, std::size_t n>
struct Codec<std::array<T, n>> {
  static Type type() {
    return {
        .kind = Type::Kind::array, .item = std::make_shared<const Type>(Codec<T>::type()), .count = {n, n}};
  }
  static bool read(const Node& node, const Spec& spec, Reader& reader, std::array<T, n>& value) {
    if (spec.one_for_all && node.as<Node::Array>() == nullptr) {
      T one{};
      if (!Codec<T>::read(node, spec, reader, one)) return false;
      value.fill(one);
      return true;
    }
    const Node::Array* entries = reader.array(node, {n, n}, codec_detail::kind_of<T>());
    return entries != nullptr && codec_detail::read_entries<T>(*entries, spec, reader, value);
  }
  static Node write(const std::array<T, n>& value) { return codec_detail::write_entries(value); }
};

template <HasFields S>
struct Codec<S> {
  static const Table<S>& table() { return fields_of(static_cast<const S*>(nullptr)); }
  static Type type() { return {.kind = Type::Kind::table, .table = &table().info()}; }
  static bool read(const Node& node, const Spec&, Reader& reader, S& value) {
    return table().read(node, reader, value);
  }
  static Node write(const S& value) { return table().write(value); }
};

/// Codec of one of several tables. The key "kind" has the name of the table.
template <HasFields... S>
struct Codec<std::variant<S...>> {
  using Value = std::variant<S...>;
  static constexpr std::string_view tag = "kind";

  static Type type() { return {.kind = Type::Kind::one_of, .alternatives = {&Codec<S>::table().info()...}}; }

  static bool read(const Node& node, const Spec&, Reader& reader, Value& value) {
    if (node.as<Node::Table>() == nullptr) return reader.unexpected(node, "a table"), false;
    const std::vector<std::string> kinds{Codec<S>::table().info().name...};
    const Node* kind = node.find(tag);
    if (kind == nullptr) {
      reader.problem(fmt::format("{} is missing: expected one of \"{}\"", tag, fmt::join(kinds, "\", \"")));
      return false;
    }
    const auto* name = kind->as<std::string>();
    bool known = false;
    bool read_well = false;
    const auto try_one = [&]<class One>(std::type_identity<One>) {
      if (name == nullptr || *name != Codec<One>::table().info().name) return;
      known = true;
      read_well = Codec<One>::table().read(node, reader, value.template emplace<One>(), tag);
    };
    (try_one(std::type_identity<S>{}), ...);
    if (!known) {
      const Reader::Scope scope(reader, tag, kind->where);
      reader.unexpected_choice(*kind, kinds);
    }
    return read_well;
  }

  static Node write(const Value& value) {
    return std::visit(
        []<class One>(const One& one) {
          Node node = Codec<One>::table().write(one);
          auto& members = *node.template as<Node::Table>();
          members.insert(members.begin(), {std::string(tag), {}, {Codec<One>::table().info().name, {}}});
          return node;
        },
        value);
  }
};

}  // namespace flexura
