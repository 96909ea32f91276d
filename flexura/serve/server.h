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

/// Where a server listens and what it bears.
struct ServerConfig {
  std::string address = "127.0.0.1";  ///< Of the interface; another than loopback only when someone asks.
  std::uint16_t port = 0;             ///< 0: any that is free.
  std::vector<std::string> names;     ///< Further hosts by which it may be called, beside its own addresses.
  std::size_t longest_header = std::size_t{16} * 1024;
  std::size_t longest_message = std::size_t{64} * 1024;
  std::size_t clients = 8;
  /// Of a client that does not read; one more and it is cut off. From a quarter of them on nothing is read
  /// from it.
  std::size_t waiting_texts = 1024;
  std::size_t waiting_bytes = std::size_t{4} * 1024 * 1024;  ///< Of those texts; as above.
  std::chrono::milliseconds handshake{5000};
  std::chrono::milliseconds idle{20000};
};

/// A part of the page, compressed with gzip; lives as long as the program.
struct Asset {
  std::string_view path;  ///< "/index.html"
  std::string_view content_type;
  std::span<const std::uint8_t> gzip;
};

using ClientId = std::uint64_t;

struct HttpAnswer {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::string policy;  ///< Content-Security-Policy; the server's strict one when empty.
};

/// What stands behind a server. All calls come on the server's one thread and return at once.
class Host {
 public:
  virtual ~Host() = default;
  Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  virtual void opened(ClientId client) = 0;
  virtual void closed(ClientId client) = 0;
  /// A text message of a client, at most `longest_message` bytes of UTF-8.
  virtual void said(ClientId client, std::string text) = 0;
  /// An authorised GET of something that is no asset: path and query as they came, checked for nothing.
  /// `answer` may be called once, later, from any thread.
  virtual void asked(std::string target, std::function<void(HttpAnswer)> answer) = 0;
};

/// An HTTP and WebSocket server on a thread of its own (docs/viewer-protocol.md: who may come in, and what is
/// refused how). Its methods can be called from any thread.
class Server {
 public:
  /// std::system_error when it cannot listen there.
  Server(ServerConfig config, std::span<const Asset> assets, Host& host);
  /// Closes all connections and ends its thread: nothing is called back from then on.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] const std::string& token() const;
  /// "http://127.0.0.1:8421/#token=..."; where it listens on all addresses with one that others can call, if
  /// there is any.
  [[nodiscard]] std::string url() const;

  /// Every text reaches the client, in order; one that does not read is cut off.
  void send(ClientId client, std::string text);
  /// Whether a client reads what it is sent, so that a Host may answer more of what it said. Of one that does
  /// not nothing more is read, and it is closed when that goes on for `idle`.
  [[nodiscard]] bool has_room(ClientId client) const;
  /// The newest message of a stream (a small number) reaches it; older ones that were not sent are dropped.
  void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message);
  /// Of all messages that wait for a client or are being sent to one.
  [[nodiscard]] std::size_t waiting_bytes() const;
  /// Clients to whom a message is being sent: one that does not read stays among them.
  [[nodiscard]] std::size_t busy_clients() const;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace flexura
