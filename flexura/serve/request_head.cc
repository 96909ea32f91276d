#include "flexura/serve/request_head.h"

#include <algorithm>
#include <array>
#include <utility>

namespace flexura {

namespace {

// Of two such fields, another program might use the other one.
constexpr std::array<std::string_view, 8> single_fields = {
    "host",           "origin",         "authorization",     "cookie",
    "content-length", "sec-fetch-site", "sec-websocket-key", "sec-websocket-version"};

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool is_token(std::string_view text) {
  constexpr std::string_view marks = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::ranges::all_of(text, [&](char c) {
    return is_letter_or_digit(c) || marks.find(c) != std::string_view::npos;
  });
}

/// Printable ASCII without the blank.
bool is_visible(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c > ' ' && c < '\x7f'; });
}

/// Returns true if a value has no control characters except the tab.
bool is_value(std::string_view text) {
  return std::ranges::all_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == '\t' || (byte >= ' ' && byte != 0x7f);
  });
}

/// Removes and returns the text up to `end`; all of it if there is no `end`.
std::string_view take(std::string_view& text, std::string_view end) {
  const std::size_t at = text.find(end);
  const std::string_view piece = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + end.size());
  return piece;
}

int parse_request_line(std::string_view line, RequestHead& head) {
  const std::string_view method = take(line, " ");
  const std::string_view target = take(line, " ");
  constexpr std::string_view protocol = "HTTP/";
  if (!is_token(method) || !is_visible(target) || !line.starts_with(protocol)) return 400;
  if (line.find_first_not_of("0123456789.", protocol.size()) != std::string_view::npos) return 400;
  if (line != "HTTP/1.1" && line != "HTTP/1.0") return 505;
  head.method = method;
  head.target = target;
  head.minor = line.back() - '0';
  return 0;
}

int parse_field(std::string_view line, RequestHead& head) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) return 400;
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (!is_value(value)) return 400;
  std::string name = in_lower_case(line.substr(0, colon));
  if (std::ranges::find(single_fields, name) != single_fields.end() && head.find(name) != nullptr) return 400;
  head.fields.push_back({std::move(name), std::string(value)});
  return 0;
}

bool has_body(const RequestHead& head) {
  const std::string* length = head.find("content-length");
  return head.find("transfer-encoding") != nullptr || (length != nullptr && *length != "0");
}

}  // namespace

const std::string* RequestHead::find(std::string_view name) const {
  const auto field = std::ranges::find(fields, name, &Field::name);
  return field == fields.end() ? nullptr : &field->value;
}

bool RequestHead::lists(std::string_view name, std::string_view token) const {
  return std::ranges::any_of(fields, [&](const Field& field) {
    if (field.name != name) return false;
    for (std::string_view rest = field.value; !rest.empty();) {
      if (in_lower_case(trimmed(take(rest, ","))) == token) return true;
    }
    return false;
  });
}

std::variant<RequestHead, Refusal> parse_request_head(std::string_view text) {
  RequestHead head;
  int status = parse_request_line(take(text, "\r\n"), head);
  while (status == 0 && !text.empty()) status = parse_field(take(text, "\r\n"), head);
  if (status == 0 && head.minor == 1 && head.find("host") == nullptr) status = 400;
  if (status == 0 && has_body(head)) status = 413;
  if (status != 0) return Refusal{status};
  head.keep_alive = head.minor == 1 && !head.lists("connection", "close");
  return head;
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace flexura
