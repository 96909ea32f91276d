#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <thread>

#include "flexura/serve/http_session.h"
#include "flexura/serve/server.h"

// Includes Boost.Asio; only for the server's source files.
namespace flexura {

namespace net = boost::asio;
using net::ip::tcp;
using ErrorCode = boost::system::error_code;

/// Receives an error that does not matter, such as the error of closing a closed socket, and ignores it.
inline void disregard(const ErrorCode&) {}

/// The server's thread and its data. Data that other threads use are guarded by `mutex_`.
class Server::Loop {
 public:
  Loop(ServerConfig config, std::span<const Asset> assets, Host& host);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const Gate& gate() const { return site_.gate; }
  [[nodiscard]] const std::string& url() const { return url_; }
  void send(ClientId client, std::string text);
  void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message);
  [[nodiscard]] bool has_room(ClientId client);
  [[nodiscard]] std::size_t waiting_bytes();
  [[nodiscard]] std::size_t busy_clients();

 private:
  class Visit;
  class Client;
  class Reply;

  static tcp::acceptor listen(net::io_context& context, const ServerConfig& config);
  [[nodiscard]] Site make_site(std::span<const Asset> assets) const;
  [[nodiscard]] std::string make_url() const;
  void accept();
  [[nodiscard]] bool make_room();
  void welcome(tcp::socket socket);
  void wake();
  void flush();

  ServerConfig config_;
  Host* host_;
  std::shared_ptr<net::io_context> context_ = std::make_shared<net::io_context>(1);
  tcp::acceptor acceptor_;
  net::steady_timer accept_timer_{*context_};
  std::uint16_t port_;
  Site site_;
  std::string url_;
  ClientId last_client_ = 0;
  std::uint64_t last_visit_ = 0;
  std::set<std::shared_ptr<Visit>> visits_;

  std::mutex mutex_;
  std::map<ClientId, std::shared_ptr<Client>> clients_;  // Their outboxes are also guarded by mutex_.
  bool woken_ = false;                                   // flush() has been posted.
  std::thread thread_;
};

}  // namespace flexura
