#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/serve/request_head.h"

namespace flexura {

/// Who may come in: by which names the server is called, from which pages, and with which token.
class Gate {
 public:
  /// `names`: further hosts, each with this port where it has none of its own ("name", "name:port").
  Gate(std::uint16_t port, const std::vector<std::string>& names, std::string token);

  /// Whether a Host header names this server; `local` is the address at which the connection came in, without
  /// port, for which "localhost" is a name where it is loopback. Browsers that were lured here by a name of
  /// someone else's (DNS rebinding) say that name.
  [[nodiscard]] bool knows_host(std::string_view host, std::string_view local) const;
  /// Whether an Origin header is a page of this server. It is held against the list and not against Host: the
  /// port counts, for cookies are shared between ports.
  [[nodiscard]] bool knows_origin(std::string_view origin, std::string_view local) const;
  /// Whether the request shows the token: "Bearer TOKEN" in its Authorization header, or a cookie of any
  /// name whose value it is.
  [[nodiscard]] bool has_token(const RequestHead& head) const;
  /// Whether its Authorization header does.
  [[nodiscard]] bool has_bearer(const RequestHead& head) const;
  /// The cookie with the token for a page that calls this server by `host`. No script reads it, and no page
  /// of another host has it sent. Cookies know no ports: its name has that of `host`, so that each of two
  /// programs on a host has its own.
  [[nodiscard]] std::string cookie(std::string_view host) const;
  [[nodiscard]] const std::string& token() const { return token_; }

 private:
  std::uint16_t port_;
  std::vector<std::string> hosts_;  // "name:port" in lower case.
  std::string token_;
};

/// Whether a browser can call a server so: a name of letters, digits, - and _ between single dots, or an IP
/// address (of version 6 in brackets), with or without ":port". What else stands in an address does not.
[[nodiscard]] bool is_host(std::string_view text);

/// "127.0.0.1" and "[::1]" as they stand in a URL.
std::string url_host(std::string_view address);

}  // namespace flexura
