#include "flexura/campaign/braces.h"

#include <fmt/format.h>

#include <utility>

#include "flexura/base/source.h"

namespace flexura {
namespace {

constexpr std::size_t most_parameters = 500;

std::vector<std::string> parts_of(std::string_view list) {
  std::vector<std::string> parts;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = list.find(',');
    parts.emplace_back(list.substr(0, comma));
    if (comma != std::string_view::npos) list.remove_prefix(comma + 1);
  }
  return parts;
}

// Returns the expansion of a text in a parameter with `count` paths.
std::vector<std::string> expanded_along(const std::string& text, std::size_t count,
                                        const SourcePosition& where) {
  std::vector<std::string> texts = expanded_braces(text, most_parameters);
  if (texts.size() != count)
    throw InputError(std::vector<Problem>{
        {where,
         fmt::format("\"{}\" expands to {} texts, but `path` expands to {}: expected equal lists in braces",
                     text, texts.size(), count)}});
  return texts;
}

// Appends the parameters that one table of the file stands for.
void expand(const Node& parameter, Node::Array& list) {
  const Node* path = parameter.find("path");
  const auto* text = path == nullptr ? nullptr : path->as<std::string>();
  const auto paths = text == nullptr ? std::vector<std::string>{""} : expanded_braces(*text, most_parameters);
  if (paths.empty())
    throw InputError(std::vector<Problem>{
        {path->where, fmt::format("\"{}\": expected at most {} parameters", *text, most_parameters)}});
  if (paths.size() == 1 && (text == nullptr || paths.front() == *text)) {
    list.push_back(parameter);
    return;
  }
  std::vector<Node> made(paths.size(), parameter);
  const auto replace = [&](const std::string& old, const SourcePosition& where, const auto& place_in) {
    const std::vector<std::string> texts = expanded_along(old, paths.size(), where);
    for (std::size_t i = 0; i < made.size(); ++i) place_in(made[i])->value = texts[i];
  };
  replace(*text, path->where, [](Node& one) { return one.find("path"); });
  const Node* name = parameter.find("name");
  if (name != nullptr && name->as<std::string>() != nullptr)
    replace(*name->as<std::string>(), name->where, [](Node& one) { return one.find("name"); });
  const Node* also = parameter.find("also");
  const auto* others = also == nullptr ? nullptr : also->as<Node::Array>();
  for (std::size_t k = 0; others != nullptr && k < others->size(); ++k)
    if (const auto* other = (*others)[k].as<std::string>())
      replace(*other, (*others)[k].where,
              [k](Node& one) { return &(*one.find("also")->as<Node::Array>())[k]; });
  for (Node& one : made) list.push_back(std::move(one));
}

}  // namespace

std::vector<std::string> expanded_braces(std::string_view text, std::size_t most) {
  std::vector<std::string> texts{""};
  while (true) {
    const std::size_t open = text.find('{'), close = text.find('}', open);
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    const std::vector<std::string> parts = parts_of(text.substr(open + 1, close - open - 1));
    if (texts.size() * parts.size() > most) return {};
    std::vector<std::string> longer;
    for (const std::string& start : texts) {
      for (const std::string& part : parts) {
        std::string& one = longer.emplace_back(start);
        one += text.substr(0, open);
        one += part;
      }
    }
    texts = std::move(longer);
    text.remove_prefix(close + 1);
  }
  for (std::string& one : texts) one += text;
  return texts;
}

Node with_expanded_parameters(Node document) {
  Node* parameters = document.find("parameter");
  auto* list = parameters == nullptr ? nullptr : parameters->as<Node::Array>();
  if (list == nullptr) return document;
  Node::Array expanded;
  for (const Node& parameter : *list) expand(parameter, expanded);
  *list = std::move(expanded);
  return document;
}

}  // namespace flexura
