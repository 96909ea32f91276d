#include "python/bindings/toml_text.h"

#include <fmt/format.h>

#include <cmath>

#include "flexura/store/json.h"

namespace flexura::python {
namespace {

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", value);
  // A whole number remains a floating-point number.
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

// JSON's quotes and escapes are also TOML's.
std::string quoted(const std::string& text) { return write_json(text_node(text)); }

std::string value_text(const Node& node) {
  if (const auto* number = node.as<double>()) return number_text(*number);
  if (const auto* text = node.as<std::string>()) return quoted(*text);
  std::string result;
  if (const auto* entries = node.as<Node::Array>()) {
    for (const Node& entry : *entries) result += (result.empty() ? "" : ", ") + value_text(entry);
    return "[" + result + "]";
  }
  if (const auto* members = node.as<Node::Table>()) {
    for (const Node::Member& member : *members)
      result += (result.empty() ? "" : ", ") + quoted(member.key) + " = " + value_text(member.node);
    return "{" + result + "}";
  }
  return node.literal();
}

}  // namespace

std::string toml_text(const Node::Table& table) {
  std::string text;
  for (const Node::Member& member : table)
    text += quoted(member.key) + " = " + value_text(member.node) + "\n";
  return text;
}

std::vector<std::string> set_texts(const py::dict& sets) {
  std::vector<std::string> texts;
  for (const auto& [path, value] : sets)
    texts.push_back(fmt::format("{}={}", py::cast<std::string>(path), value_text(node_of(value))));
  return texts;
}

}  // namespace flexura::python
