#include "flexura/base/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace flexura {
namespace {

// Returns a path as in a TOML header, without indices: "task.loop" for "task[0].loop".
std::string without_indices(std::string_view path) {
  std::string names;
  bool is_index = false;
  for (const char c : path) {
    if (c == '[') is_index = true;
    if (!is_index) names += c;
    if (c == ']') is_index = false;
  }
  return names;
}

}  // namespace

Reader::Scope::Scope(Reader& reader, std::string_view name, const SourcePosition& where)
    : Scope(reader, name, name, where) {}

Reader::Scope::Scope(Reader& reader, std::string_view name, std::string_view key, const SourcePosition& where)
    : reader_(reader), path_size_(reader.path_.size()) {
  if (key != name) reader_.written_.insert_or_assign(reader_.below(name), where);
  reader_.path_ = reader_.below(key);
  reader_.written_.insert_or_assign(reader_.path_, where);
}

Reader::Scope::Scope(Reader& reader, std::size_t index, const SourcePosition& where)
    : reader_(reader), path_size_(reader.path_.size()) {
  reader_.path_ += fmt::format("[{}]", index);
  reader_.written_.insert_or_assign(reader_.path_, where);
}

Reader::Scope::~Scope() { reader_.path_.resize(path_size_); }

std::string Reader::below(std::string_view name) const {
  const bool joined = path_.empty() || name.empty() || name.front() == '[';
  return fmt::format("{}{}{}", path_, joined ? "" : ".", name);
}

void Reader::problem(std::string what) { problem_at("", std::move(what)); }

// Returns the position of the value at `path` or, if the document has no such value, of the longest part of
// the path in the document.
SourcePosition Reader::place_of(std::string path) const {
  auto found = written_.find(path);
  while (found == written_.end() && !path.empty()) {
    const std::size_t cut = path.find_last_of(".[");
    path.resize(cut == std::string::npos ? 0 : cut);
    found = written_.find(path);
  }
  return found == written_.end() ? SourcePosition{} : found->second;
}

void Reader::problem_at(std::string_view path, std::string what) {
  const std::string whole = below(path);
  problems_.push_back({place_of(whole), whole.empty() ? std::move(what) : whole + ": " + what});
}

void Reader::problem_in_text(std::string_view path, const std::string& text, std::size_t offset,
                             std::string what) {
  const std::string whole = below(path);
  SourcePosition where = place_of(whole);
  if (where.text_column > 0) {
    where.column = where.text_column + static_cast<int>(offset);
  } else {
    what += fmt::format(" at character {} of {}", offset + 1, Node{text, {}}.brief());
  }
  problems_.push_back({where, whole + ": " + what});
}

void Reader::unexpected(const Node& node, std::string_view expected) {
  const bool is_whole = node.as<Node::Array>() != nullptr || node.as<Node::Table>() != nullptr;
  if (path_.empty()) {
    problems_.push_back({node.where, fmt::format("{}: expected {}", node.brief(), expected)});
    return;
  }
  const std::string what = fmt::format("{} {}: expected {}", is_whole ? "is" : "=", node.brief(), expected);
  problems_.push_back({node.where, path_ + " " + what});
}

void Reader::unexpected_choice(const Node& node, const std::vector<std::string>& choices) {
  std::string expected = fmt::format("one of \"{}\"", fmt::join(choices, "\", \""));
  if (const auto* word = node.as<std::string>()) {
    std::string small = *word;
    for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (const std::string_view near = nearest_name(small, choices); !near.empty())
      expected += fmt::format("; did you mean \"{}\"?", near);
  }
  unexpected(node, expected);
}

void Reader::throw_if_any() const {
  if (!problems_.empty()) throw InputError(problems_);
}

bool Reader::number(const Node& node, const Spec& spec, double& value) {
  std::optional<double> written;
  if (const auto* whole = node.as<std::int64_t>())
    written = static_cast<double>(*whole);
  else if (const auto* real = node.as<double>())
    written = *real;
  const double scaled = written.value_or(0) * spelling.factor;
  if (written && std::isfinite(scaled) && spec.range.contains(scaled)) {
    value = scaled;
    return true;
  }
  // Makes the text only on an error, because a file may have millions of numbers.
  const std::string range = spec.range.text(spelling);
  const std::string unit = spelling.symbol.empty() ? "" : fmt::format(" in {}", spelling.symbol);
  unexpected(node, range.empty() ? "a finite number" + unit : "a number " + range);
  return false;
}

bool Reader::integer(const Node& node, const Spec& spec, std::int64_t& value) {
  const auto* whole = node.as<std::int64_t>();
  if (whole == nullptr || !spec.range.contains(static_cast<double>(*whole))) {
    const std::string range = spec.range.text(spelling);
    unexpected(node, range.empty() ? "a whole number" : "a whole number " + range);
    return false;
  }
  value = *whole;
  return true;
}

bool Reader::text(const Node& node, std::string& value) {
  const auto* written = node.as<std::string>();
  if (written == nullptr) {
    unexpected(node, "a text in quotes");
    return false;
  }
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
  if (const auto found = std::ranges::find_if(*written, is_control); found != written->end()) {
    unexpected(node, fmt::format("a text on one line, without U+{:04X}", static_cast<unsigned char>(*found)));
    return false;
  }
  value = *written;
  return true;
}

const Node::Array* Reader::array(const Node& node, const Count& count, Type::Kind item) {
  const auto* entries = node.as<Node::Array>();
  if (entries != nullptr && entries->size() >= count.min && entries->size() <= count.max) return entries;
  const bool is_of_tables = item == Type::Kind::table || item == Type::Kind::one_of;
  if (is_of_tables && node.as<Node::Table>() != nullptr) {
    unexpected(node, fmt::format("several, as tables [[{}]]", without_indices(path_)));
    return nullptr;
  }
  constexpr std::size_t no_bound = std::numeric_limits<std::size_t>::max();
  if (count.min == count.max) {
    unexpected(node, fmt::format("an array of {}", count.min));
  } else if (count.max == no_bound) {
    unexpected(node, count.min == 0 ? "an array" : fmt::format("an array of at least {}", count.min));
  } else {
    unexpected(node, fmt::format("an array of {} to {}", count.min, count.max));
  }
  return nullptr;
}

namespace {

bool has_suffix(const FieldInfo& field, std::string_view key, UnitSpelling& spelling) {
  if (!key.starts_with(field.name)) return false;
  const std::string_view suffix = key.substr(field.name.size());
  const auto known = spellings(field.spec.unit);
  const auto found = std::ranges::find(known, suffix, &UnitSpelling::suffix);
  if (found == known.end()) return false;
  spelling = *found;
  return true;
}

std::string ways_to_write(const FieldInfo& field) {
  std::string ways;
  for (const UnitSpelling& way : spellings(field.spec.unit)) {
    ways += fmt::format("{}{}{}{}", ways.empty() ? "" : ", ", field.name, way.suffix,
                        way.symbol.empty() ? "" : fmt::format(" ({})", way.symbol));
  }
  return ways;
}

// Returns the field that an unknown key probably means, which has another unit or a similar name; null if
// there is none.
const FieldInfo* field_in_another_unit(std::string_view key, const TableInfo& table) {
  const auto found = std::ranges::find_if(table.fields, [&](const FieldInfo& field) {
    return key.starts_with(field.name) &&
           std::ranges::count(all_unit_suffixes(), key.substr(field.name.size())) > 0;
  });
  return found == table.fields.end() ? nullptr : &*found;
}

std::string_view nearest_spelling(std::string_view key, const TableInfo& table, std::string_view tag,
                                  std::vector<std::string>& names) {
  for (const FieldInfo& field : table.fields) {
    for (const UnitSpelling& way : spellings(field.spec.unit))
      names.push_back(field.name + std::string(way.suffix));
  }
  if (!tag.empty()) names.emplace_back(tag);
  return nearest_name(key, names);
}

// Returns the field of `table` that is a table, or an array of tables, with a field of this name; null if
// there is none.
const FieldInfo* table_with(std::string_view key, const TableInfo& table) {
  const auto has_key = [key](const FieldInfo& field) {
    const TableInfo* inner = field.type.item ? field.type.item->table : field.type.table;
    UnitSpelling spelling{};
    return inner != nullptr && std::ranges::any_of(inner->fields, [&](const FieldInfo& candidate) {
             return has_suffix(candidate, key, spelling);
           });
  };
  const auto found = std::ranges::find_if(table.fields, has_key);
  return found == table.fields.end() ? nullptr : &*found;
}

// Error text for an unknown key ("did you mean ..."), and the field that is probably meant.
struct UnknownKey {
  std::string what;
  const FieldInfo* meant = nullptr;
};

// Returns the error for a key that is a field's old name, in any unit; empty for other keys.
std::optional<UnknownKey> renamed_key(std::string_view key, const TableInfo& table) {
  for (const RenamedField& renamed : table.renamed) {
    if (!key.starts_with(renamed.old_name)) continue;
    const std::string_view suffix = key.substr(renamed.old_name.size());
    if (!suffix.empty() && std::ranges::count(all_unit_suffixes(), suffix) == 0) continue;
    return UnknownKey{fmt::format("is now called \"{}{}\"", renamed.name, suffix), table.find(renamed.name)};
  }
  return std::nullopt;
}

UnknownKey unknown_key(std::string_view key, const TableInfo& table, std::string_view tag) {
  if (auto renamed = renamed_key(key, table)) return *std::move(renamed);
  if (const FieldInfo* field = field_in_another_unit(key, table)) {
    return {field->spec.unit == Unit::none
                ? fmt::format("unknown key: {} has no unit, write {}", field->name, field->name)
                : fmt::format("wrong unit: expected {}", ways_to_write(*field)),
            field};
  }
  std::vector<std::string> names;
  if (const std::string_view near = nearest_spelling(key, table, tag, names); !near.empty()) {
    UnitSpelling spelling{};
    const auto meant = std::ranges::find_if(
        table.fields, [&](const FieldInfo& field) { return has_suffix(field, near, spelling); });
    return {fmt::format("unknown key; did you mean \"{}\"?", near),
            meant == table.fields.end() ? nullptr : &*meant};
  }
  if (const FieldInfo* inner = table_with(key, table))
    return {fmt::format("unknown key; it belongs in {} \"{}\"", inner->type.item ? "each" : "the table",
                        inner->name)};
  if (table.fields.empty()) return {"unknown key; no keys are expected here"};
  std::string known;
  for (const FieldInfo& field : table.fields) known += (known.empty() ? "" : ", ") + field.name;
  return {fmt::format("unknown key; expected one of: {}", known)};
}

std::string missing(const FieldInfo& field) {
  const NumberRange& range = field.spec.range;
  const std::string bounds = range.text(spellings(field.spec.unit).front());
  std::string expected = "a value";
  if (field.type.kind == Type::Kind::number) expected = bounds.empty() ? "a number" : "a number " + bounds;
  if (field.type.kind == Type::Kind::table) expected = "a table";
  if (field.type.kind == Type::Kind::array) expected = "an array";
  const std::string meaning = field.spec.meaning.empty() ? "" : fmt::format(" ({})", field.spec.meaning);
  return fmt::format("missing: expected {}{}", expected, meaning);
}

}  // namespace

std::vector<FoundField> find_fields(const Node& node, const TableInfo& table, Reader& reader,
                                    std::string_view tag) {
  std::vector<FoundField> found(table.fields.size());
  std::vector<const FieldInfo*> meant;
  const auto* members = node.as<Node::Table>();
  if (members == nullptr) {
    reader.unexpected(node, "a table");
    return {};
  }
  for (const Node::Member& member : *members) {
    if (!tag.empty() && member.key == tag) continue;
    const std::string shown_key = Node{member.key, {}}.brief();
    UnitSpelling spelling{};
    const auto field = std::ranges::find_if(table.fields, [&](const FieldInfo& candidate) {
      return has_suffix(candidate, member.key, spelling);
    });
    if (field == table.fields.end()) {
      const Reader::Scope scope(reader, std::string_view(shown_key).substr(1, shown_key.size() - 2),
                                member.where);
      UnknownKey unknown = unknown_key(member.key, table, tag);
      reader.problem(std::move(unknown.what));
      meant.push_back(unknown.meant);
      continue;
    }
    FoundField& slot = found[static_cast<std::size_t>(field - table.fields.begin())];
    if (slot.member != nullptr) {
      const Reader::Scope scope(reader, member.key, member.where);
      const SourcePosition& first = slot.member->where;
      const bool same_file = first.source == member.where.source || first.source == nullptr;
      reader.problem(fmt::format("occurs twice: {} is already in line {}{}", slot.member->key, first.line,
                                 same_file ? "" : " of " + *first.source));
      continue;
    }
    slot = {&member, spelling};
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const FieldInfo& field = table.fields[i];
    // A misspelt field is not also reported as missing.
    if (found[i].member == nullptr && field.spec.required && std::ranges::count(meant, &field) == 0)
      reader.problem_at(field.name, missing(field));
  }
  return found;
}

}  // namespace flexura
