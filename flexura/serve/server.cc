#include "flexura/serve/server.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cstddef>
#include <system_error>
#include <utility>
#include <vector>

#include "flexura/serve/own_address.h"
#include "flexura/serve/server_client.h"
#include "flexura/serve/server_loop.h"
#include "flexura/serve/server_visit.h"
#include "flexura/serve/token.h"

namespace flexura {

namespace {

// Most connections that are not (yet) clients: a browser has six; others wait in the system's queue.
constexpr std::size_t most_visits = 64;
// Size of the system's send buffer per client: small, so that slow clients do not receive old data.
constexpr int send_buffer_bytes = 128 * 1024;
constexpr std::chrono::milliseconds accept_again{100};

}  // namespace

Server::Loop::Loop(ServerConfig config, std::span<const Asset> assets, Host& host)
    : config_(std::move(config)),
      host_(&host),
      acceptor_(listen(*context_, config_)),
      port_(acceptor_.local_endpoint().port()),
      site_(make_site(assets)),
      url_(make_url()) {
  accept();
  thread_ = std::thread([this] { context_->run(); });
}

Server::Loop::~Loop() {
  context_->stop();
  thread_.join();
  // A host with an open answer keeps the context and the handlers that wait in it.
  for (const auto& visit : visits_) visit->close();
  for (const auto& [id, client] : clients_) client->cut_off();
}

tcp::acceptor Server::Loop::listen(net::io_context& context, const ServerConfig& config) {
  try {
    return {context, tcp::endpoint(net::ip::make_address(config.address), config.port)};
  } catch (const boost::system::system_error& error) {
    throw std::system_error(
        error.code().value(), std::system_category(),
        "cannot listen on " + url_host(config.address) + ':' + std::to_string(config.port));
  }
}

Site Server::Loop::make_site(std::span<const Asset> assets) const {
  return {Gate(port_, config_.names, new_token()), assets, config_.longest_header};
}

std::string Server::Loop::make_url() const {
  const auto address = acceptor_.local_endpoint().address();
  // For a server on all addresses, shows one that others can use.
  const std::string shown =
      address.is_unspecified() ? outward_address(own_addresses(), address.is_v6()) : address.to_string();
  return "http://" + url_host(shown) + ':' + std::to_string(port_) + "/#token=" + gate().token();
}

void Server::Loop::accept() {
  acceptor_.async_accept([this](ErrorCode error, tcp::socket socket) {
    if (error) {  // Most likely too many open files.
      accept_timer_.expires_after(accept_again);
      accept_timer_.async_wait([this](ErrorCode) { accept(); });
    } else {
      if (visits_.size() < most_visits || make_room()) welcome(std::move(socket));
      accept();
    }
  });
}

// Ends the oldest visit without the token. So newcomers are heard however many others connect and say
// nothing: each of them has the time until `most_visits` more have come. Returns false if all visits have the
// token.
bool Server::Loop::make_room() {
  std::shared_ptr<Visit> oldest;
  for (const std::shared_ptr<Visit>& visit : visits_)
    if (!visit->has_shown_token() && (!oldest || visit->number() < oldest->number())) oldest = visit;
  if (oldest) oldest->end();
  return oldest != nullptr;
}

void Server::Loop::welcome(tcp::socket socket) {
  ErrorCode error;
  disregard(socket.set_option(tcp::no_delay(true), error));
  disregard(socket.set_option(net::socket_base::send_buffer_size(send_buffer_bytes), error));
  const auto visit = std::make_shared<Visit>(*this, std::move(socket));
  visits_.insert(visit);
  visit->start();
}

void Server::Loop::send(ClientId client, std::string text) {
  const std::lock_guard lock(mutex_);
  const auto place = clients_.find(client);
  if (place == clients_.end()) return;
  Client& there = *place->second;
  there.overflowed = there.overflowed || !there.outbox.push(std::move(text));
  wake();
}

void Server::Loop::post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message) {
  const std::lock_guard lock(mutex_);
  const auto place = clients_.find(client);
  if (place == clients_.end()) return;
  place->second->outbox.post(stream, std::move(message));
  wake();
}

bool Server::Loop::has_room(ClientId client) {
  const std::lock_guard lock(mutex_);
  const auto place = clients_.find(client);
  return place == clients_.end() || place->second->outbox.has_room();
}

std::size_t Server::Loop::waiting_bytes() {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = 0;
  for (const auto& [id, client] : clients_) bytes += client->outbox.bytes();
  return bytes;
}

std::size_t Server::Loop::busy_clients() {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(
      std::ranges::count_if(clients_, [](const auto& entry) { return entry.second->outbox.is_sending(); }));
}

/// Requires the mutex. Posts at most one flush() at a time, so the loop's queue stays short.
void Server::Loop::wake() {
  if (std::exchange(woken_, true)) return;
  net::post(*context_, [this] { flush(); });
}

void Server::Loop::flush() {
  std::vector<std::shared_ptr<Client>> clients;
  {
    const std::lock_guard lock(mutex_);
    woken_ = false;
    for (const auto& [id, client] : clients_) clients.push_back(client);
  }
  for (const auto& client : clients) client->write();
}

// --- The server
// -----------------------------------------------------------------------------------------------

Server::Server(ServerConfig config, std::span<const Asset> assets, Host& host)
    : loop_(std::make_unique<Loop>(std::move(config), assets, host)) {}
Server::~Server() = default;

std::uint16_t Server::port() const { return loop_->port(); }
const std::string& Server::token() const { return loop_->gate().token(); }
std::string Server::url() const { return loop_->url(); }
void Server::send(ClientId client, std::string text) { loop_->send(client, std::move(text)); }
void Server::post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message) {
  loop_->post(client, stream, std::move(message));
}
bool Server::has_room(ClientId client) const { return loop_->has_room(client); }
std::size_t Server::waiting_bytes() const { return loop_->waiting_bytes(); }
std::size_t Server::busy_clients() const { return loop_->busy_clients(); }

}  // namespace flexura
