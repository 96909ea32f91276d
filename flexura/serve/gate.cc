#include "flexura/serve/gate.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/serve/token.h"

namespace flexura {

namespace {

/// Returns "name:port" in lower case, with `port` if the text has none.
std::string with_port(std::string_view host, std::uint16_t port) {
  const std::size_t colon = host.rfind(':');
  const std::size_t bracket = host.rfind(']');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || bracket < colon);
  std::string text = in_lower_case(host);
  if (!has_port) text += ':' + std::to_string(port);
  return text;
}

constexpr std::uint16_t http_port = 80;

// The port without its colon.
bool is_port(std::string_view text) {
  constexpr std::size_t longest = 5;
  constexpr int most = 65535;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.empty() || text.size() > longest || !std::ranges::all_of(text, is_digit)) return false;
  const int port = std::stoi(std::string(text));
  return port > 0 && port <= most;
}

// RFC 1123, 2.1, plus underscores, which occur in practice.
bool is_label(std::string_view text) {
  constexpr std::size_t longest = 63;
  const auto is_sign = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
  };
  return !text.empty() && text.size() <= longest && std::ranges::all_of(text, is_sign) &&
         text.front() != '-' && text.back() != '-';
}

bool is_name(std::string_view text) {
  constexpr std::size_t longest = 253;
  if (text.size() > longest) return false;
  for (std::size_t from = 0;;) {
    const std::size_t dot = std::min(text.find('.', from), text.size());
    if (!is_label(text.substr(from, dot - from))) return false;
    if (dot == text.size()) return true;
    from = dot + 1;
  }
}

bool is_v6(std::string_view text) {
  in6_addr parsed{};
  return ::inet_pton(AF_INET6, std::string(text).c_str(), &parsed) == 1;
}

bool is_loopback(std::string_view address) { return address.starts_with("127.") || address == "::1"; }

}  // namespace

Gate::Gate(std::uint16_t port, const std::vector<std::string>& names, std::string token)
    : port_(port), token_(std::move(token)) {
  for (const std::string& name : names) hosts_.push_back(with_port(name, port));
}

bool Gate::knows_host(std::string_view host, std::string_view local) const {
  const std::string called = with_port(host, http_port);
  if (is_loopback(local) && called == with_port("localhost", port_)) return true;
  return called == with_port(url_host(local), port_) || std::ranges::find(hosts_, called) != hosts_.end();
}

bool Gate::knows_origin(std::string_view origin, std::string_view local) const {
  constexpr std::string_view scheme = "http://";
  return origin.starts_with(scheme) && knows_host(origin.substr(scheme.size()), local);
}

bool Gate::has_bearer(const RequestHead& head) const {
  const std::string* value = head.find("authorization");
  constexpr std::string_view scheme = "bearer ";
  return value != nullptr && in_lower_case(value->substr(0, scheme.size())) == scheme &&
         equal_in_constant_time(trimmed(std::string_view(*value).substr(scheme.size())), token_);
}

std::string Gate::cookie(std::string_view host) const {
  const std::string called = with_port(host, http_port);
  return "flexura_" + called.substr(called.rfind(':') + 1) + '=' + token_ +
         "; Path=/; HttpOnly; SameSite=Strict";
}

bool Gate::has_token(const RequestHead& head) const {
  bool found = has_bearer(head);
  const std::string* value = head.find("cookie");
  for (std::string_view rest = value == nullptr ? std::string_view() : *value; !rest.empty();) {
    const std::string_view pair = trimmed(rest.substr(0, rest.find(';')));
    rest.remove_prefix(std::min(rest.size(), rest.find(';')));
    if (!rest.empty()) rest.remove_prefix(1);
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos) continue;
    found = equal_in_constant_time(pair.substr(equals + 1), token_) || found;
  }
  return found;
}

bool is_host(std::string_view text) {
  const bool is_bracketed = text.starts_with('[');
  const std::size_t end = is_bracketed ? text.find(']') : std::min(text.find(':'), text.size());
  if (end == std::string_view::npos) return false;
  const std::string_view host = is_bracketed ? text.substr(1, end - 1) : text.substr(0, end);
  const std::string_view rest = text.substr(is_bracketed ? end + 1 : end);
  if (!rest.empty() && !(rest.starts_with(':') && is_port(rest.substr(1)))) return false;
  return is_bracketed ? is_v6(host) : is_name(host);
}

std::string url_host(std::string_view address) {
  const bool v6 = address.find(':') != std::string_view::npos;
  return v6 ? '[' + std::string(address) + ']' : std::string(address);
}

}  // namespace flexura
