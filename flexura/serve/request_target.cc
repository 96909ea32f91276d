#include "flexura/serve/request_target.h"

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace flexura {

namespace {

std::optional<std::string> decoded(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain.push_back(text[i]);
      continue;
    }
    unsigned char byte = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const char* const last = digits.data() + digits.size();
    const char* const first = digits.data();
    if (digits.size() != 2 || std::from_chars(first, last, byte, 16).ptr != last) return std::nullopt;
    plain.push_back(static_cast<char>(byte));
    i += 2;
  }
  return plain;
}

bool is_control(char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }

/// Returns true if a path has no "." and "..", backslashes or control characters.
bool is_plain(std::string_view path) {
  if (path.find('\\') != std::string_view::npos || std::ranges::any_of(path, is_control)) return false;
  while (!path.empty()) {
    path.remove_prefix(1);  // The "/" before each part.
    const std::string_view part = path.substr(0, path.find('/'));
    if (part == "." || part == "..") return false;
    path.remove_prefix(part.size());
  }
  return true;
}

bool parse_query(std::string_view text, RequestTarget& target) {
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    const auto key = decoded(pair.substr(0, equals));
    const auto value = decoded(equals == std::string_view::npos ? "" : pair.substr(equals + 1));
    if (!key || !value) return false;
    if (!pair.empty()) target.query.emplace_back(*key, *value);
  }
  return true;
}

}  // namespace

const std::string* RequestTarget::find(std::string_view key) const {
  const auto pair = std::ranges::find(query, key, &std::pair<std::string, std::string>::first);
  return pair == query.end() ? nullptr : &pair->second;
}

std::optional<RequestTarget> parse_request_target(std::string_view text) {
  if (!text.starts_with('/')) return std::nullopt;
  const std::size_t mark = text.find('?');
  const auto path = decoded(text.substr(0, mark));
  if (!path || !is_plain(*path)) return std::nullopt;
  RequestTarget target{*path, {}};
  if (mark != std::string_view::npos && !parse_query(text.substr(mark + 1), target)) return std::nullopt;
  return target;
}

}  // namespace flexura
