#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// Address and limits of a server.
struct ServerConfig {
  std::string address = "127.0.0.1";  ///< Address of the interface on which the server listens; by default
                                      ///< only this machine can connect.
  std::uint16_t port = 0;             ///< 0: any free port.
  std::vector<std::string> names;     ///< Further host names of the server, in addition to its addresses.
  std::size_t longest_header = std::size_t{16} * 1024;
  std::size_t longest_message = std::size_t{64} * 1024;
  std::size_t clients = 8;
  /// Largest number of waiting texts per client. One more text closes the connection. Above a quarter of this
  /// number, the server reads nothing from the client.
  std::size_t waiting_texts = 1024;
  std::size_t waiting_bytes =
      std::size_t{4} * 1024 * 1024;  ///< Limit of the total size of the waiting texts, bytes.
  std::chrono::milliseconds handshake{5000};
  std::chrono::milliseconds idle{20000};
};

/// A file of the page in static storage, compressed with gzip.
struct Asset {
  std::string_view path;  ///< Path in URLs, such as "/index.html".
  std::string_view content_type;
  std::span<const std::uint8_t> gzip;
};

using ClientId = std::uint64_t;

struct HttpAnswer {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::string policy;  ///< Content-Security-Policy; if empty, the strict policy of the server.
};

/// The program behind a server. All functions are called on the server's thread and must return immediately.
class Host {
 public:
  virtual ~Host() = default;
  Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  virtual void opened(ClientId client) = 0;
  virtual void closed(ClientId client) = 0;
  /// Receives a text message of a client, at most `longest_message` bytes of UTF-8.
  virtual void on_message(ClientId client, std::string text) = 0;
  /// Receives an authorised GET request for a target that is not an asset. `target`: path and query as
  /// received, unchecked. `answer` may be called once, at any time, from any thread.
  virtual void asked(std::string target, std::function<void(HttpAnswer)> answer) = 0;
};

/// An HTTP and WebSocket server with its own thread (docs/viewer-protocol.md: access control and refusals).
/// Thread-safe.
class Server {
 public:
  /// Throws std::system_error if the server cannot listen at the address.
  Server(ServerConfig config, std::span<const Asset> assets, Host& host);
  /// Closes all connections and ends the server's thread; the host is not called afterwards.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] const std::string& token() const;
  /// Returns the URL of the page, such as "http://127.0.0.1:8421/#token=...". If the server listens on all
  /// addresses, the URL has an address that other machines can use, if there is one.
  [[nodiscard]] std::string url() const;

  /// Sends a text. Every text reaches the client, in order. A client that does not read is disconnected.
  void send(ClientId client, std::string text);
  /// Returns true if a client reads its messages fast enough, so that a Host may answer further requests. If
  /// a client does not read, the server reads nothing more from it, and disconnects it after `idle`.
  [[nodiscard]] bool has_room(ClientId client) const;
  /// Sends the newest message of a stream, which is identified by a small number. Older messages of the
  /// stream that were not sent are discarded.
  void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message);
  /// Returns the total size of all messages that wait for a client or are being sent, bytes.
  [[nodiscard]] std::size_t waiting_bytes() const;
  /// Returns the number of clients to which a message is being sent, including clients that do not read.
  [[nodiscard]] std::size_t busy_clients() const;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace flexura
