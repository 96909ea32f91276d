#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace flexura {

/// A request or reply of HTTP/1.1, with the parts that ONVIF needs.
struct HttpMessage {
  int status = 0;            ///< Status of a reply, such as 200; 0 for a request.
  std::string method;        ///< Method of a request, such as "POST".
  std::string target;        ///< Path of a request.
  std::string authenticate;  ///< Kinds of login that a reply asks for (header WWW-Authenticate).
  std::string body;          ///< Body, without chunked encoding.
  bool keeps_open = false;   ///< Whether the connection may carry another message.
  /// Whether the message marks the end of its body; otherwise the connection's end is the body's end.
  bool is_delimited = false;
};

/// Finds messages in a stream of bytes. Messages have a limited size: 16 KiB of headers and 1 MiB of body.
class HttpReader {
 public:
  /// Kind of the messages in a stream.
  enum class Side { requests, replies };
  explicit HttpReader(Side side);
  ~HttpReader();
  HttpReader(HttpReader&&) noexcept;
  HttpReader& operator=(HttpReader&&) noexcept;

  /// Adds bytes that have arrived.
  void put(std::string_view bytes);
  /// Reports the end of the connection.
  void close();
  /// Returns the next complete message, or std::nullopt. Interim replies, such as status 100, are omitted.
  std::optional<HttpMessage> next();
  /// Returns the reason, in one line, why the bytes are not valid HTTP; "" if they are valid so far. After an
  /// error, further bytes are ignored.
  [[nodiscard]] const std::string& problem() const;

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
};

/// Returns a request that posts a SOAP message. `host`: name or IP address, and port, for the header.
/// `keeps_open`: whether further requests will be sent on the same connection.
[[nodiscard]] std::string http_post(std::string_view host, std::string_view path, std::string_view soap,
                                    bool keeps_open);
/// Returns a reply with a SOAP message. `headers`: further header lines, each with its line end.
[[nodiscard]] std::string http_reply(int status, std::string_view soap, bool keeps_open,
                                     bool is_chunked = false, std::string_view headers = {});

}  // namespace flexura
