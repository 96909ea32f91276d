#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/serve/request_head.h"

namespace flexura {

/// Access control of the server: its host names, allowed pages and the token.
class Gate {
 public:
  /// `names`: further host names of this server ("name" or "name:port"). For a name without a port, the port
  /// is `port`.
  Gate(std::uint16_t port, const std::vector<std::string>& names, std::string token);

  /// Returns true if a Host header names this server. `local` is the local address of the connection, without
  /// port; "localhost" is accepted if this address is a loopback address. The check prevents DNS rebinding,
  /// in which a browser sends the attacker's host name.
  [[nodiscard]] bool knows_host(std::string_view host, std::string_view local) const;
  /// Returns true if an Origin header is the origin of a page of this server. The function compares the
  /// Origin header with the known host names, not with the Host header. The port must agree too, because
  /// browsers share cookies between ports.
  [[nodiscard]] bool knows_origin(std::string_view origin, std::string_view local) const;
  /// Returns true if the request has the token: "Bearer TOKEN" in its Authorization header, or a cookie of
  /// any name with the token as value.
  [[nodiscard]] bool has_token(const RequestHead& head) const;
  /// Returns true if the request's Authorization header has the token.
  [[nodiscard]] bool has_bearer(const RequestHead& head) const;
  /// Returns the cookie with the token for a page that uses `host` for this server. Scripts cannot read this
  /// cookie, and browsers do not send it with requests from pages of other hosts. The cookie's name includes
  /// the port of `host`: browsers share cookies between ports, so two programs on a host need different
  /// names.
  [[nodiscard]] std::string cookie(std::string_view host) const;
  [[nodiscard]] const std::string& token() const { return token_; }

 private:
  std::uint16_t port_;
  std::vector<std::string> hosts_;  // "name:port" in lower case.
  std::string token_;
};

/// Returns true if a browser can use this name for a server. Such a name consists of letters, digits, - and _
/// between single dots, or an IP address (version 6 in brackets), with or without ":port". Returns false for
/// everything else.
[[nodiscard]] bool is_host(std::string_view text);

/// Returns the address as in a URL: "127.0.0.1" or "[::1]".
std::string url_host(std::string_view address);

}  // namespace flexura
