#include "flexura/store/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

std::string type_text(const Type& type, const Spec& spec, const Count& count) {
  switch (type.kind) {
    case Type::Kind::boolean:
      return "true or false";
    case Type::Kind::integer:
      return "whole number";
    case Type::Kind::number:
      return "number";
    case Type::Kind::text:
      return "text";
    case Type::Kind::bytes:
      return "text in base64";
    case Type::Kind::choice:
      return fmt::format("`\"{}\"`", fmt::join(type.choices, "\"` or `\""));
    case Type::Kind::table:
    case Type::Kind::one_of:
      return "table";
    case Type::Kind::array:
      break;
  }
  const Count& bounds = type.count.min > 0 ? type.count : count;
  const std::string item = type_text(*type.item, spec, {});
  const std::string size = bounds.min == bounds.max ? fmt::format(" {}", bounds.min) : std::string();
  // "array of 2 numbers", "array of arrays of 2 numbers".
  const std::size_t first_word = std::min(item.find(' '), item.size());
  const std::string items = item.ends_with("whole number")
                                ? item + "s"
                                : item.substr(0, first_word) + "s" + item.substr(first_word);
  return fmt::format("{}array of{} {}", spec.one_for_all ? item + ", or " : "", size, items);
}

void add_table_section(const TableInfo& info, const std::string& path, const std::string& heading,
                       std::string& out);

void add_sections_below(const Type& type, const std::string& path, bool repeated, std::string& out) {
  switch (type.kind) {
    case Type::Kind::array:
      add_sections_below(*type.item, path, true, out);
      break;
    case Type::Kind::table:
      add_table_section(*type.table, path,
                        repeated ? fmt::format("`[[{}]]`", path) : fmt::format("`[{}]`", path), out);
      break;
    case Type::Kind::one_of:
      for (const TableInfo* alternative : type.alternatives) {
        add_table_section(*alternative, path,
                          fmt::format("`[[{}]]`, `kind = \"{}\"`", path, alternative->name), out);
      }
      break;
    default:
      break;
  }
}

void add_table_section(const TableInfo& info, const std::string& path, const std::string& heading,
                       std::string& out) {
  if (!heading.empty()) out += fmt::format("\n## {}\n", heading);
  out += fmt::format(
      "\n{}\n\n| key | value | unit | range | default | meaning |\n| --- | --- | --- | --- | --- | --- |\n",
      info.meaning);
  for (const FieldInfo& field : info.fields) {
    std::string keys;
    std::string units;
    for (const UnitSpelling& way : spellings(field.spec.unit)) {
      keys += fmt::format("{}`{}{}`", keys.empty() ? "" : ", ", field.name, way.suffix);
      units += fmt::format("{}{}", units.empty() ? "" : ", ", way.symbol);
    }
    out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", keys,
                       type_text(field.type, field.spec, field.spec.count), units,
                       field.spec.range.text(spellings(field.spec.unit).front()),
                       field.spec.required ? "required" : field.default_text, field.spec.meaning);
  }
  for (const FieldInfo& field : info.fields) {
    if (field.spec.partial) continue;  // Parts of tables with sections elsewhere.
    add_sections_below(field.type, path + (path.empty() ? "" : ".") + field.name, false, out);
  }
}

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

std::string markdown_reference(const TableInfo& info) {
  std::string out = fmt::format("# {}\n", info.name);
  add_table_section(info, "", "", out);
  return out;
}

}  // namespace flexura
