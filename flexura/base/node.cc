#include "flexura/base/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "flexura/base/unit.h"

namespace flexura {
namespace {

struct BriefVisitor {
  std::string operator()(std::monostate) const { return "nothing"; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return std::isnan(value) ? "nan" : fmt::format("{}", value); }
  std::string operator()(const std::string& value) const {
    constexpr std::size_t longest = 40;
    // Does not split a UTF-8 character.
    std::size_t end = std::min(longest, value.size());
    while (end < value.size() && end > 0 && (static_cast<unsigned char>(value[end]) & 0xC0U) == 0x80) --end;
    std::string shown;
    for (const char c : value.substr(0, end)) shown += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return fmt::format("\"{}{}\"", shown, value.size() > longest ? "..." : "");
  }
  std::string operator()(const Node::Array& value) const {
    return value.empty() ? "an empty array" : fmt::format("an array of {}", value.size());
  }
  std::string operator()(const Node::Table&) const { return "a table"; }
  std::string operator()(const Node::Other& value) const { return value.name; }
};

// Follows one part of a path from `node`: a key of a table (made if missing) or an index of an array.
std::string step_into(Node*& node, std::string_view part, const SourcePosition& where) {
  if (auto* array = node->as<Node::Array>()) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    if (error != std::errc{} || end != part.data() + part.size()) {
      return fmt::format("\"{}\" refers to an entry of an array: expected the entry's index, counted from 0",
                         part);
    }
    if (index >= array->size())
      return fmt::format("the index {} is outside an array of size {}", index, array->size());
    node = &(*array)[index];
    return {};
  }
  auto* table = node->as<Node::Table>();
  if (table == nullptr) return fmt::format("nothing named \"{}\" inside {}", part, node->brief());
  Node* found = node->find(part);
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  if (found == nullptr && std::ranges::all_of(part, is_digit))
    return fmt::format(
        "entry {} cannot be set because the array does not exist: set the whole array, as [..., ...]", part);
  if (found == nullptr) {
    table->push_back({std::string(part), where, {Node::Table{}, where}});
    found = &table->back().node;
  }
  node = found;
  return {};
}

// Removes a value of the same quantity in another unit, for example length if length_mm is set. Sets the
// key's position to that of the value.
void make_way(Node& node, std::string_view key, const SourcePosition& where) {
  auto* members = node.as<Node::Table>();
  if (members == nullptr) return;
  for (Node::Member& member : *members) {
    if (member.key == key) member.where = where;
  }
  std::erase_if(*members, [key](const Node::Member& member) {
    return member.key != key && without_unit(member.key) == without_unit(key);
  });
}

}  // namespace

const Node* Node::find(std::string_view key) const {
  const auto* table = as<Table>();
  if (table == nullptr) return nullptr;
  const auto found = std::ranges::find(*table, key, &Member::key);
  return found == table->end() ? nullptr : &found->node;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

std::string Node::brief() const { return std::visit(BriefVisitor{}, value); }

std::string Node::literal() const {
  if (as<Table>() != nullptr) return "its fields' defaults";
  const auto* entries = as<Array>();
  if (entries == nullptr) return brief();
  std::string text;
  for (const Node& entry : *entries) text += (text.empty() ? "" : ", ") + entry.literal();
  return "[" + text + "]";
}

Node number_node(double value) { return std::isfinite(value) ? Node{value, {}} : Node{}; }

Node text_node(std::string value) { return {std::move(value), {}}; }

Node texts_node(const std::vector<std::string>& values) {
  Node::Array entries;
  for (const std::string& value : values) entries.push_back(text_node(value));
  return {std::move(entries), {}};
}

void merge(Node& under, Node over) {
  auto* below = under.as<Node::Table>();
  auto* above = over.as<Node::Table>();
  if (below == nullptr || above == nullptr) {
    under = std::move(over);
    return;
  }
  for (Node::Member& member : *above) {
    const auto found = std::ranges::find(*below, member.key, &Node::Member::key);
    if (found == below->end()) {
      below->push_back(std::move(member));
    } else {
      // Merged tables keep the position of the table in `under`; other keys get the position of their new
      // value.
      if (member.node.as<Node::Table>() == nullptr) found->where = member.where;
      merge(found->node, std::move(member.node));
    }
  }
}

std::string set_at_path(Node& root, std::string_view path, Node value) {
  // Also accepts the notation of messages: section[0] means section.0.
  std::string dotted;
  for (const char c : path) {
    if (c == '[') dotted += '.';
    if (c != '[' && c != ']') dotted += c;
  }
  Node* node = &root;
  for (std::string_view rest = dotted;;) {
    const std::size_t dot = rest.find('.');
    const std::string_view part = rest.substr(0, dot);
    if (part.empty())
      return fmt::format("\"{}\" is not a path: expected names and numbers separated by dots", path);
    if (dot == std::string_view::npos) make_way(*node, part, value.where);
    if (std::string error = step_into(node, part, value.where); !error.empty()) return error;
    if (dot == std::string_view::npos) break;
    rest.remove_prefix(dot + 1);
  }
  *node = std::move(value);
  return {};
}

}  // namespace flexura
