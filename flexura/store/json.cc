#include "flexura/store/json.h"

#include <fmt/format.h>

// Only this file includes nlohmann/json (docs/architecture.md, "Heavy headers").
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/base/utf8.h"

namespace flexura {
namespace {

constexpr std::size_t max_depth = 64;

SourcePosition position_of(std::string_view text, std::size_t byte,
                           const std::shared_ptr<const std::string>& source) {
  const std::size_t at = std::min(byte, text.size());
  const std::string_view before = text.substr(0, at);
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0.
  return {source, static_cast<int>(std::ranges::count(before, '\n')) + 1,
          static_cast<int>(at - line_start) + 1};
}

// Shortens a long number or text: its middle does not help in an error message.
std::string shortened(std::string_view what) {
  constexpr std::size_t begin = 100, end = 60;
  if (what.size() <= begin + end) return std::string(what);
  std::string_view tail = what.substr(what.size() - end);
  tail.remove_prefix(static_cast<std::size_t>(
      std::ranges::find_if(tail, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80; }) -
      tail.begin()));
  return fmt::format("{}...{}", what.substr(0, utf8_length(what.substr(0, begin))), tail);
}

// Builds nodes from nlohmann's events, which show repeated keys, unlike its documents. The events have no
// positions, so later errors are named by their path; the document's own position is its start.
class NodeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  NodeBuilder(std::string_view text, const std::string& source)
      : text_(text), source_(std::make_shared<const std::string>(source)) {}

  bool null() override { return add({}); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(std::int64_t value) override { return add(value); }
  bool number_unsigned(std::uint64_t value) override {
    if (std::in_range<std::int64_t>(value)) return add(static_cast<std::int64_t>(value));
    return add(static_cast<double>(value));
  }
  bool number_float(double value, const std::string&) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(nlohmann::json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Node::Table{}); }
  bool start_array(std::size_t) override { return open(Node::Array{}); }
  bool end_object() override {
    check_keys(*open_.back()->as<Node::Table>());
    return close();
  }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    open_.back()->as<Node::Table>()->push_back({std::move(name), start(), {}});
    return true;
  }
  bool parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception& error) override {
    // nlohmann's text: "[json.exception.parse_error.101] parse error at line 1, column 5: ...".
    std::string_view what = error.what();
    for (const std::string_view before : {"] ", ": "}) {
      if (const auto at = what.find(before); at != std::string_view::npos) what.remove_prefix(at + 2);
    }
    throw InputError({{position_of(text_, byte == 0 ? 0 : byte - 1, source_),
                       fmt::format("not JSON: {}", shortened(what))}});
  }

  Node take() { return std::move(root_); }

 private:
  [[nodiscard]] SourcePosition start() const { return {source_, 1, 1}; }

  Node* place(Node node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return &root_;
    }
    if (auto* entries = open_.back()->as<Node::Array>()) return &entries->emplace_back(std::move(node));
    Node& slot = open_.back()->as<Node::Table>()->back().node;
    slot = std::move(node);
    return &slot;
  }
  bool add(Node::Value value) { return place({std::move(value), start()}) != nullptr; }
  bool open(Node::Value value) {
    if (open_.size() == max_depth) {
      throw InputError({{start(), fmt::format("nested more than {} deep", max_depth)}});
    }
    // Pointers to the open nodes stay valid: a container grows only while its last element is complete.
    open_.push_back(place({std::move(value), start()}));
    return true;
  }
  // Sorts the keys: comparing each with all others would take hours for a document of keys.
  void check_keys(const Node::Table& members) const {
    std::vector<const std::string*> names;
    names.reserve(members.size());
    for (const Node::Member& member : members) names.push_back(&member.key);
    const auto value = [](const std::string* name) -> const std::string& { return *name; };
    std::ranges::sort(names, {}, value);
    const auto twice = std::ranges::adjacent_find(names, {}, value);
    if (twice != names.end())
      throw InputError({{start(), fmt::format("the key {} occurs twice", Node{**twice, {}}.brief())}});
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  std::shared_ptr<const std::string> source_;
  Node root_;
  std::vector<Node*> open_;
};

using Json = nlohmann::ordered_json;

Json to_json(const Node& node) {
  if (const auto* value = node.as<bool>()) return *value;
  if (const auto* value = node.as<std::int64_t>()) return *value;
  if (const auto* value = node.as<double>()) return *value;
  if (const auto* value = node.as<std::string>()) return *value;
  if (const auto* entries = node.as<Node::Array>()) {
    Json array = Json::array();
    for (const Node& entry : *entries) array.push_back(to_json(entry));
    return array;
  }
  if (const auto* members = node.as<Node::Table>()) {
    Json object = Json::object();
    for (const Node::Member& member : *members) object[member.key] = to_json(member.node);
    return object;
  }
  return nullptr;
}

bool holds_containers(const Node& node) {
  const auto is_container = [](const Node& inner) {
    return inner.as<Node::Array>() != nullptr || inner.as<Node::Table>() != nullptr;
  };
  if (const auto* entries = node.as<Node::Array>()) return std::ranges::any_of(*entries, is_container);
  if (const auto* members = node.as<Node::Table>())
    return std::ranges::any_of(*members, is_container, &Node::Member::node);
  return false;
}

// Indents for readability: containers with only plain values stay on one line.
void lay_out(const Node& node, int indent, int level, std::string& out) {
  const auto* entries = node.as<Node::Array>();
  const auto* members = node.as<Node::Table>();
  const bool top_table = level == 0 && members != nullptr && !members->empty();
  if (!top_table && !holds_containers(node)) {
    out += write_json(node);
    return;
  }
  const auto new_line = [&](int depth) {
    out += '\n' + std::string(static_cast<std::size_t>(indent * depth), ' ');
  };
  out += entries != nullptr ? '[' : '{';
  const std::size_t count = entries != nullptr ? entries->size() : members->size();
  for (std::size_t i = 0; i < count; ++i) {
    new_line(level + 1);
    if (members != nullptr) out += write_json({(*members)[i].key, {}}) + ": ";
    lay_out(entries != nullptr ? (*entries)[i] : (*members)[i].node, indent, level + 1, out);
    if (i + 1 < count) out += ',';
  }
  new_line(level);
  out += entries != nullptr ? ']' : '}';
}

}  // namespace

Node parse_json(std::string_view text, const std::string& source) {
  NodeBuilder builder(text, source);
  nlohmann::json::sax_parse(text, &builder);
  return builder.take();
}

std::string write_json(const Node& node, int indent) {
  if (indent >= 0) {
    std::string out;
    lay_out(node, indent, 0, out);
    return out;
  }
  // Bytes that are not UTF-8 (in a file name, for example) become U+FFFD instead of an exception.
  return to_json(node).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace flexura
