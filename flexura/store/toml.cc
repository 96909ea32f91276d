#include "flexura/store/toml.h"

#include <fmt/format.h>

// Only this file sees toml++ (docs/architecture.md, "Heavy headers").
#define TOML_ENABLE_FORMATTERS 0
// toml++ 3.3 asserts, and with NDEBUG lets the compiler assume, that "[" is followed by the start of a key;
// where it is not, the code after that says so in good order.
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <sstream>
#include <utility>

#include "flexura/store/text_file.h"
#include "flexura/store/toml_depth.h"

namespace flexura {
namespace {

using Source = std::shared_ptr<const std::string>;

SourcePosition position(const Source& source, const toml::source_position& at) {
  return {source, static_cast<int>(at.line), static_cast<int>(at.column)};
}

// Where a text's characters begin, if they stand there as they are: after one quote or three.
int text_column(const toml::value<std::string>& text) {
  const auto& [begin, end, path] = text.source();
  if (begin.line != end.line) return 0;
  const std::size_t written = end.column - begin.column;
  for (const std::size_t quotes : {std::size_t{1}, std::size_t{3}}) {
    if (written == text.get().size() + 2 * quotes) return static_cast<int>(begin.column + quotes);
  }
  return 0;
}

template <class T>
Node::Other other(const char* kind, const T& value) {
  std::ostringstream text;
  text << value;
  return {fmt::format("the {} {}", kind, text.str())};
}

Node convert(const toml::node& node, const Source& source) {
  Node result{{}, position(source, node.source().begin)};
  if (const auto* table = node.as_table()) {
    Node::Table members;
    members.reserve(table->size());
    for (const auto& [key, value] : *table) {
      members.push_back(
          {std::string(key.str()), position(source, key.source().begin), convert(value, source)});
    }
    // toml++ keeps keys in alphabetical order; a person reads errors in the order of the file.
    std::ranges::sort(members, [](const Node::Member& a, const Node::Member& b) {
      return std::pair(a.where.line, a.where.column) < std::pair(b.where.line, b.where.column);
    });
    result.value = std::move(members);
  } else if (const auto* array = node.as_array()) {
    Node::Array entries;
    entries.reserve(array->size());
    for (const auto& value : *array) entries.push_back(convert(value, source));
    result.value = std::move(entries);
  } else if (const auto* boolean = node.as_boolean()) {
    result.value = boolean->get();
  } else if (const auto* whole = node.as_integer()) {
    result.value = whole->get();
  } else if (const auto* real = node.as_floating_point()) {
    result.value = real->get();
  } else if (const auto* text = node.as_string()) {
    result.value = text->get();
    result.where.text_column = text_column(*text);
  } else if (const auto* date = node.as_date()) {
    result.value = other("date", date->get());
  } else if (const auto* time = node.as_time()) {
    result.value = other("time", time->get());
  } else if (const auto* date_time = node.as_date_time()) {
    result.value = other("date", date_time->get());
  }
  return result;
}

constexpr int max_include_depth = 8;
constexpr int max_included_files = 100;

// Where a reading has come to: files include files, a few of which could name each other without end.
struct Including {
  int depth = 0;
  int files = 0;
};

void lay_upon_includes(Node& document, const std::filesystem::path& file, Including& including);

Node read_with_includes(const std::filesystem::path& file, Including& including) {
  Node document = parse_toml(read_text_file(file, max_toml_bytes), file.string());
  ++including.depth;
  lay_upon_includes(document, file, including);
  --including.depth;
  return document;
}

std::filesystem::path included_file(const Node& entry, const std::filesystem::path& folder) {
  const auto* name = entry.as<std::string>();
  if (name == nullptr || name->empty())
    throw InputError({{entry.where, "include: expected file names in quotes"}});
  try {
    return file_inside(folder, *name);
  } catch (const InputError& error) {
    throw InputError({{entry.where, "include: " + error.problems().front().what}});
  }
}

void lay_upon_includes(Node& document, const std::filesystem::path& file, Including& including) {
  const Node* include = document.find("include");
  if (include == nullptr) return;
  const auto* names = include->as<Node::Array>();
  if (names == nullptr) throw InputError({{include->where, "include: expected an array of file names"}});
  if (including.depth > max_include_depth) {
    throw InputError(
        {{include->where,
          fmt::format("include: more than {} files deep; does a file include itself?", max_include_depth)}});
  }
  Node below{Node::Table{}, document.where};
  for (const Node& name : *names) {
    if (++including.files > max_included_files) {
      throw InputError({{name.where, fmt::format("include: more than {} files in all", max_included_files)}});
    }
    merge(below, read_with_includes(included_file(name, file.parent_path()), including));
  }
  auto& members = *document.as<Node::Table>();
  std::erase_if(members, [](const Node::Member& member) { return member.key == "include"; });
  merge(below, std::move(document));
  document = std::move(below);
}

// Moves everything on the first line by so many columns.
void shift(Node& node, int columns) {
  if (node.where.line == 1) {
    node.where.column += columns;
    if (node.where.text_column > 0) node.where.text_column += columns;
  }
  if (auto* entries = node.as<Node::Array>()) {
    for (Node& entry : *entries) shift(entry, columns);
  }
  if (auto* members = node.as<Node::Table>()) {
    for (Node::Member& member : *members) {
      if (member.where.line == 1) member.where.column += columns;
      shift(member.node, columns);
    }
  }
}

}  // namespace

Node parse_toml(std::string_view text, const std::string& source) {
  check_toml_depth(text, source);
  try {
    const toml::table table = toml::parse(text, source);
    Node document = convert(table, std::make_shared<const std::string>(source));
    document.where.line = document.where.column = 1;
    return document;
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    throw input_error(source, std::string(error.description()), static_cast<int>(at.line),
                      static_cast<int>(at.column));
  }
}

Node parse_toml_value(std::string_view text, const std::string& source, int line, int column) {
  const SourcePosition where{std::make_shared<const std::string>(source), line, column};
  const bool is_word =
      !text.empty() &&
      std::ranges::all_of(text, [](unsigned char c) { return std::isalpha(c) || c == '_' || c == '-'; }) &&
      text != "true" && text != "false" && text != "inf" && text != "nan" && text != "-inf" && text != "-nan";
  if (is_word) return {std::string(text), where};
  constexpr std::string_view before = "value = ";
  Node document;
  try {
    document = parse_toml(std::string(before) + std::string(text), source);
  } catch (const InputError& error) {
    throw InputError({{where, error.problems().front().what}});
  }
  const auto* members = document.as<Node::Table>();
  if (members->size() != 1) throw InputError({{where, "expected one value"}});
  Node value = members->front().node;
  shift(value, column - static_cast<int>(before.size()) - 1);
  value.where.line = line;
  return value;
}

Node read_toml_file(const std::filesystem::path& file) {
  Including including;
  return read_with_includes(file, including);
}

}  // namespace flexura
