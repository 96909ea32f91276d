#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "flexura/store/toml.h"

namespace flexura {
namespace {

bool is_bare_key(std::string_view key) {
  return !key.empty() && std::ranges::all_of(key, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string quote(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\u{:04x}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string key_text(std::string_view key) { return is_bare_key(key) ? std::string(key) : quote(key); }

std::string real_text(double value) {
  std::string text = fmt::format("{}", value);
  // 2.0 must not read back as the integer 2.
  if (text.find_first_of(".eni") == std::string::npos) text += ".0";
  return text;
}

bool is_array_of_tables(const Node& node) {
  const auto* entries = node.as<Node::Array>();
  return entries != nullptr && !entries->empty() &&
         std::ranges::all_of(*entries, [](const Node& entry) { return entry.as<Node::Table>() != nullptr; });
}

bool stands_alone(const Node& node) { return node.as<Node::Table>() != nullptr || is_array_of_tables(node); }

std::string value_text(const Node& node) {
  if (const auto* value = node.as<bool>()) return *value ? "true" : "false";
  if (const auto* value = node.as<std::int64_t>()) return fmt::format("{}", *value);
  if (const auto* value = node.as<double>()) return real_text(*value);
  if (const auto* value = node.as<std::string>()) return quote(*value);
  std::string text;
  if (const auto* entries = node.as<Node::Array>()) {
    for (const Node& entry : *entries) text += (text.empty() ? "" : ", ") + value_text(entry);
    return "[" + text + "]";
  }
  if (const auto* members = node.as<Node::Table>()) {
    for (const Node::Member& member : *members) {
      text +=
          fmt::format("{}{} = {}", text.empty() ? "" : ", ", key_text(member.key), value_text(member.node));
    }
    return "{ " + text + " }";
  }
  return "\"\"";
}

// Returns the description of the table under a field, if any; for one_of, that of the alternative of `node`.
const TableInfo* table_of(const FieldInfo* field, const Node& node) {
  if (field == nullptr) return nullptr;
  const Type* type = &field->type;
  while (type->kind == Type::Kind::array) type = type->item.get();
  if (type->kind == Type::Kind::table) return type->table;
  const Node* kind = node.find("kind");
  for (const TableInfo* alternative : type->alternatives) {
    if (kind != nullptr && kind->as<std::string>() != nullptr &&
        *kind->as<std::string>() == alternative->name) {
      return alternative;
    }
  }
  return nullptr;
}

void write_members(const Node& table, const TableInfo* info, const std::string& path, std::string& out) {
  for (const Node::Member& member : *table.as<Node::Table>()) {
    if (stands_alone(member.node)) continue;
    const FieldInfo* field = info == nullptr ? nullptr : info->find(member.key);
    const std::string_view unit = field == nullptr ? "" : symbol(field->spec.unit);
    out += fmt::format("{} = {}", key_text(member.key), value_text(member.node));
    out += unit.empty() ? "\n" : fmt::format("  # {}\n", unit);
  }
  for (const Node::Member& member : *table.as<Node::Table>()) {
    if (!stands_alone(member.node)) continue;
    const FieldInfo* field = info == nullptr ? nullptr : info->find(member.key);
    const std::string name = path + (path.empty() ? "" : ".") + key_text(member.key);
    if (member.node.as<Node::Table>() != nullptr) {
      out += fmt::format("\n[{}]\n", name);
      write_members(member.node, table_of(field, member.node), name, out);
      continue;
    }
    for (const Node& entry : *member.node.as<Node::Array>()) {
      out += fmt::format("\n[[{}]]\n", name);
      write_members(entry, table_of(field, entry), name, out);
    }
  }
}

}  // namespace

std::string write_toml(const Node& table, const TableInfo& info) {
  std::string out;
  write_members(table, &info, "", out);
  return out;
}

}  // namespace flexura
