#include "flexura/store/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flexura {
namespace {

Node text(std::string value) { return {std::move(value), {}}; }
Node whole(std::size_t value) { return {static_cast<std::int64_t>(value), {}}; }

void add(Node& table, std::string key, Node value) {
  table.as<Node::Table>()->push_back({std::move(key), {}, std::move(value)});
}

Node object() { return {Node::Table{}, {}}; }

// `partial`: nothing is required, here and below.
Node table_schema(const TableInfo& info, bool tagged, bool partial);

// Returns a bound in the unit of a spelling, without digits from rounding in the conversion.
Node bound(double value, double factor) {
  const double shown = std::stod(fmt::format("{:.12g}", value / factor));
  constexpr double largest_whole = 9007199254740992.0;
  if (std::abs(shown) <= largest_whole && shown == std::trunc(shown))
    return {static_cast<std::int64_t>(shown), {}};
  return {shown, {}};
}

void add_range(Node& schema, const NumberRange& range, double factor) {
  if (std::isfinite(range.min)) {
    add(schema, range.open_min ? "exclusiveMinimum" : "minimum", bound(range.min, factor));
  }
  if (std::isfinite(range.max)) add(schema, "maximum", bound(range.max, factor));
}

void add_count(Node& schema, const Count& count) {
  if (count.min > 0) add(schema, "minItems", whole(count.min));
  if (count.max != Count{}.max) add(schema, "maxItems", whole(count.max));
}

Node any_of(Node::Array choices) {
  Node schema = object();
  add(schema, "anyOf", {std::move(choices), {}});
  return schema;
}

// `count` is that of the outermost array, from the field.
Node value_schema(const Type& type, const Spec& spec, const Count& count, double factor) {
  Node schema = object();
  switch (type.kind) {
    case Type::Kind::boolean:
      add(schema, "type", text("boolean"));
      return schema;
    case Type::Kind::integer:
      add(schema, "type", text("integer"));
      add_range(schema, spec.range, factor);
      return schema;
    case Type::Kind::number:
      add(schema, "type", text("number"));
      add_range(schema, spec.range, factor);
      return schema;
    case Type::Kind::text:
      add(schema, "type", text("string"));
      return schema;
    case Type::Kind::bytes:
      add(schema, "type", text("string"));
      add(schema, "contentEncoding", text("base64"));
      return schema;
    case Type::Kind::choice: {
      Node::Array names;
      for (const std::string& name : type.choices) names.push_back(text(name));
      add(schema, "enum", {std::move(names), {}});
      return schema;
    }
    case Type::Kind::array: {
      add(schema, "type", text("array"));
      add(schema, "items", value_schema(*type.item, spec, {}, factor));
      add_count(schema, type.count.min > 0 ? type.count : count);
      if (spec.one_for_all) return any_of({value_schema(*type.item, spec, {}, factor), std::move(schema)});
      return schema;
    }
    case Type::Kind::table:
      return table_schema(*type.table, false, spec.partial);
    case Type::Kind::one_of: {
      Node::Array alternatives;
      for (const TableInfo* alternative : type.alternatives)
        alternatives.push_back(table_schema(*alternative, true, spec.partial));
      return any_of(std::move(alternatives));
    }
  }
  return schema;
}

Node table_schema(const TableInfo& info, bool tagged, bool partial) {
  Node properties = object();
  Node::Array required;
  Node::Array required_quantities;
  if (tagged) {
    Node kind = object();
    add(kind, "const", text(info.name));
    add(properties, "kind", std::move(kind));
    required.push_back(text("kind"));
  }
  for (const FieldInfo& field : info.fields) {
    const auto ways = spellings(field.spec.unit);
    Spec spec = field.spec;
    spec.partial = spec.partial || partial;
    Node::Array one_of_ways;
    for (const UnitSpelling& way : ways) {
      const std::string name = field.name + std::string(way.suffix);
      Node schema = value_schema(field.type, spec, spec.count, way.factor);
      std::string meaning = field.spec.meaning;
      if (!way.symbol.empty()) meaning += fmt::format(" [{}]", way.symbol);
      if (!field.default_text.empty()) meaning += fmt::format(" Default: {}.", field.default_text);
      add(schema, "description", text(meaning));
      add(properties, name, std::move(schema));
      Node way_required = object();
      add(way_required, "required", {Node::Array{text(name)}, {}});
      one_of_ways.push_back(std::move(way_required));
    }
    if (!spec.required || partial) continue;
    if (ways.size() == 1) {
      required.push_back(text(field.name));
    } else {
      required_quantities.push_back(any_of(std::move(one_of_ways)));
    }
  }
  Node schema = object();
  add(schema, "type", text("object"));
  add(schema, "description", text(info.meaning));
  add(schema, "properties", std::move(properties));
  add(schema, "additionalProperties", {false, {}});
  if (!required.empty()) add(schema, "required", {std::move(required), {}});
  if (!required_quantities.empty()) add(schema, "allOf", {std::move(required_quantities), {}});
  return schema;
}

// --- Markdown ---

// A bound of a range: 1e6 rather than 1000000.
std::string bound_text(double value) {
  constexpr double long_number = 1e5;
  const double size = std::abs(value);
  if (size < long_number) return fmt::format("{:g}", value);
  const double exponent = std::floor(std::log10(size)), mantissa = value / std::pow(10, exponent);
  return fmt::format("{:g}e{:g}", mantissa, exponent);
}

// As an interval, "(0, 1e4] s"; "> 0 m" and ">= 0 m" without an upper bound. The unit alone where every
// number is in the range.
std::string range_text(const NumberRange& range, std::string_view unit) {
  std::string text;
  if (std::isfinite(range.min) && std::isfinite(range.max))
    text = fmt::format("{}{}, {}]", range.open_min ? '(' : '[', bound_text(range.min), bound_text(range.max));
  else if (std::isfinite(range.min))
    text = fmt::format("{} {}", range.open_min ? ">" : ">=", bound_text(range.min));
  else if (std::isfinite(range.max))
    text = fmt::format("<= {}", bound_text(range.max));
  return fmt::format("{}{}{}", text, text.empty() || unit.empty() ? "" : " ", unit);
}

// One of them, or several: "number" and "numbers".
std::string type_text(const Type& type, bool several) {
  const char* s = several ? "s" : "";
  switch (type.kind) {
    case Type::Kind::boolean:
      return fmt::format("boolean{}", s);
    case Type::Kind::integer:
      return fmt::format("integer{}", s);
    case Type::Kind::number:
      return fmt::format("number{}", s);
    case Type::Kind::text:
      return fmt::format("text{}", s);
    case Type::Kind::bytes:
      return fmt::format("text{} in base64", s);
    case Type::Kind::choice:
      return fmt::format("`\"{}\"`", fmt::join(type.choices, "\"`, `\""));
    case Type::Kind::table:
    case Type::Kind::one_of:
      return fmt::format("table{}", s);
    case Type::Kind::array:
      break;
  }
  const std::string items = type_text(*type.item, true);
  const std::string size = type.count.min > 0 && type.count.min == type.count.max
                               ? fmt::format("{} ", type.count.min)
                               : std::string();
  return fmt::format("{}{}{}", several ? "arrays of " : "", size, items);
}

// "number", "3 numbers", "arrays of 2 numbers", "number or 2 numbers", with the range.
std::string value_text(const FieldInfo& field) {
  Type type = field.type;
  const Count& count = field.spec.count;
  if (type.kind == Type::Kind::array && type.count.min == 0 && count.min == count.max) type.count = count;
  std::string text = type_text(type, false);
  const bool are_choices = type.item != nullptr && type.item->kind == Type::Kind::choice;
  if (field.spec.one_for_all && are_choices)
    text = "one or several of " + text;
  else if (field.spec.one_for_all)
    text = fmt::format("{} or {}", type_text(*type.item, false), text);
  const std::string range = range_text(field.spec.range, spellings(field.spec.unit).front().symbol);
  return range.empty() ? text : fmt::format("{}, {}", text, range);
}

std::string row_of(const FieldInfo& field) {
  std::string keys;
  for (const UnitSpelling& way : spellings(field.spec.unit))
    keys += fmt::format("{}`{}{}`", keys.empty() ? "" : ", ", field.name, way.suffix);
  // A table that is left out has its fields' defaults, unless something else is given.
  const bool is_whole = field.type.kind == Type::Kind::table && field.spec.default_text.empty();
  const std::string otherwise = is_whole ? std::string() : field.default_text;
  return fmt::format("| {} | {} | {} | {} |\n", keys, value_text(field),
                     field.spec.required ? "required" : otherwise, field.spec.meaning);
}

// The rows of these fields, if there are any.
std::string rows_of(const std::vector<const FieldInfo*>& fields) {
  if (fields.empty()) return {};
  std::string rows = "| key | value | default | meaning |\n|---|---|---|---|\n";
  for (const FieldInfo* field : fields) rows += row_of(*field);
  return rows;
}

bool has_row(const TableInfo& info, const FieldInfo& field) {
  const FieldInfo* found = info.find(field.name);
  return found != nullptr && row_of(*found) == row_of(field);
}

// Builds the page: a section for each table. What is the same in several tables is described once.
class Page {
 public:
  explicit Page(const TableInfo& info)
      : text_(fmt::format(
            "# {}\n\nA key's suffix is its unit: `_mm`, `_ms`, `_deg` for degrees, `_pi` for multiples of pi "
            "rad. Keys without a suffix, ranges and defaults are in SI units (m, s, rad). In a range, `[` "
            "and "
            "`]` include the bound and `(` excludes it. Several values are a TOML array.\n",
            info.name)) {
    add_table(info, "", {});
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  struct Section {
    const TableInfo* table;
    std::string link;
  };

  // As GitHub makes it, with a number where several headings read alike.
  std::string anchor_of(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
      const bool is_word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
      if (is_word || c == ' ') anchor += c == ' ' ? '-' : c;
    }
    const int before = anchors_[anchor]++;
    return before == 0 ? anchor : fmt::format("{}-{}", anchor, before);
  }

  std::string add_heading(const std::string& heading) {
    text_ += fmt::format("\n## {}\n", heading);
    return fmt::format("[{}](#{})", heading, anchor_of(heading));
  }

  // The section of a table, or a link to the one that it has. `common`: fields that are described elsewhere.
  void add_section(const TableInfo& info, const std::string& path, const std::string& heading,
                   const std::vector<const FieldInfo*>& common) {
    const std::string link = add_heading(heading);
    const auto before = std::ranges::find(sections_, &info, &Section::table);
    if (before != sections_.end()) {
      text_ += fmt::format("\nKeys: see {}.\n", before->link);
      return;
    }
    add_table(info, path, common);
    sections_.push_back({&info, link});
  }

  // What the table means, a row for each field, and the sections of the tables in it.
  void add_table(const TableInfo& info, const std::string& path,
                 const std::vector<const FieldInfo*>& common) {
    // Of a table that has all the fields of another one: these are described there.
    constexpr std::size_t fewest = 3;
    const auto part = std::ranges::find_if(sections_, [&](const Section& section) {
      const auto& fields = section.table->fields;
      return fields.size() >= fewest &&
             std::ranges::all_of(fields, [&](const FieldInfo& field) { return has_row(info, field); });
    });
    const bool has_part = part != sections_.end();
    std::vector<const FieldInfo*> own;
    for (const FieldInfo& field : info.fields) {
      const bool is_common = std::ranges::find(common, field.name, &FieldInfo::name) != common.end();
      const bool is_in_part = has_part && part->table->find(field.name) != nullptr;
      if (!is_common && !is_in_part) own.push_back(&field);
    }
    const std::string also =
        has_part ? fmt::format(" This table also accepts the keys of {}.", part->link) : "";
    const std::string rows = rows_of(own);
    text_ += fmt::format("\n{}{}\n{}{}", info.meaning, also, rows.empty() ? "" : "\n", rows);
    for (const FieldInfo* field : own) {
      if (field->spec.partial) continue;  // Parts of tables that have their sections elsewhere.
      add_below(field->type, path + (path.empty() ? "" : ".") + field->name, false);
    }
  }

  void add_below(const Type& type, const std::string& path, bool repeated) {
    if (type.kind == Type::Kind::array) add_below(*type.item, path, true);
    if (type.kind == Type::Kind::table)
      add_section(*type.table, path, fmt::format(fmt::runtime(repeated ? "`[[{}]]`" : "`[{}]`"), path), {});
    if (type.kind == Type::Kind::one_of) add_alternatives(type.alternatives, path);
  }

  // The fields that all have, then each.
  void add_alternatives(const std::vector<const TableInfo*>& tables, const std::string& path) {
    std::vector<const FieldInfo*> common;
    for (const FieldInfo& field : tables.front()->fields) {
      const auto has_it = [&](const TableInfo* table) { return has_row(*table, field); };
      if (tables.size() > 1 && std::ranges::all_of(tables, has_it)) common.push_back(&field);
    }
    if (!common.empty()) {
      (void)add_heading(fmt::format("`[[{}]]`", path));
      text_ += "\nKeys of every kind:\n\n" + rows_of(common);
    }
    for (const TableInfo* table : tables)
      add_section(*table, path, fmt::format("`[[{}]]`, `kind = \"{}\"`", path, table->name), common);
  }

  std::string text_;
  std::map<std::string, int> anchors_;
  std::vector<Section> sections_;
};

}  // namespace

Node json_schema(const TableInfo& info) {
  Node schema = object();
  add(schema, "$schema", text("http://json-schema.org/draft-07/schema#"));
  add(schema, "title", text(info.name));
  Node body = table_schema(info, false, false);
  const bool may_include = info.find("include") != nullptr;
  for (Node::Member& member : *body.as<Node::Table>()) {
    if (may_include && member.key == "required") {
      // Included files may have the required keys, but an editor sees only one file.
      Node as_it_stands = object(), with_others = object();
      add(as_it_stands, "required", std::move(member.node));
      add(with_others, "required", {Node::Array{text("include")}, {}});
      add(schema, "anyOf", {Node::Array{std::move(as_it_stands), std::move(with_others)}, {}});
    } else {
      add(schema, std::move(member.key), std::move(member.node));
    }
  }
  return schema;
}

std::string markdown_reference(const TableInfo& info) { return Page(info).text(); }

}  // namespace flexura
