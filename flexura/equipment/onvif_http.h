#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace flexura {

/// A request or reply of HTTP/1.1, as far as ONVIF needs it.
struct HttpMessage {
  int status = 0;             ///< Of a reply, such as 200; 0 for a request.
  std::string method;         ///< Of a request, such as "POST".
  std::string target;         ///< Of a request: the path.
  std::string authenticate;   ///< Kinds of login that a reply asks for (header WWW-Authenticate).
  std::string body;           ///< After removal of a chunked encoding.
  bool keeps_open = false;    ///< Whether the connection may carry another message.
  bool is_delimited = false;  ///< Whether the end of the body is marked, not just the end of the connection.
};

/// Finds messages in a stream of bytes. Messages have a limited size: 16 KiB of headers and 1 MiB of body.
class HttpReader {
 public:
  /// What a stream carries.
  enum class Side { requests, replies };
  explicit HttpReader(Side side);
  ~HttpReader();
  HttpReader(HttpReader&&) noexcept;
  HttpReader& operator=(HttpReader&&) noexcept;

  /// Takes bytes that have arrived.
  void put(std::string_view bytes);
  /// Takes the end of the connection.
  void close();
  /// Returns the next complete message, or std::nullopt. Interim replies, such as 100, are left out.
  std::optional<HttpMessage> next();
  /// Returns why the bytes are not HTTP, in one line; "" as long as they may be. After that, nothing is read.
  [[nodiscard]] const std::string& problem() const;

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
};

/// Returns a request that posts a SOAP message. `host`: name or number and port, for the header.
/// `keeps_open`: whether to ask for further requests on the same connection.
[[nodiscard]] std::string http_post(std::string_view host, std::string_view path, std::string_view soap,
                                    bool keeps_open);
/// Returns a reply with a SOAP message. `headers`: further lines, each with its end.
[[nodiscard]] std::string http_reply(int status, std::string_view soap, bool keeps_open,
                                     bool is_chunked = false, std::string_view headers = {});

}  // namespace flexura
