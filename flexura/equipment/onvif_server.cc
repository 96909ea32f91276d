#include "flexura/equipment/onvif_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "flexura/equipment/wall_clock.h"

namespace flexura {

OnvifServer::OnvifServer(OnvifDevice& device, std::uint16_t port)
    : device_(device), listening_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  sockaddr_in place{};
  place.sin_family = AF_INET, place.sin_addr.s_addr = htonl(INADDR_LOOPBACK), place.sin_port = htons(port);
  socklen_t size = sizeof place;
  const int yes = 1;
  constexpr int most_waiting = 16;
  if (listening_) (void)::setsockopt(listening_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (!listening_ || ::bind(listening_.get(), reinterpret_cast<const sockaddr*>(&place), size) != 0 ||
      ::listen(listening_.get(), most_waiting) != 0 ||
      ::getsockname(listening_.get(), reinterpret_cast<sockaddr*>(&place), &size) != 0)
    throw std::runtime_error(fmt::format("TCP port {}: {}", port, std::strerror(errno)));
  port_ = ntohs(place.sin_port);
  device_.model().host = fmt::format("127.0.0.1:{}", port_);
  thread_ = std::thread([this] { run(); });
}

OnvifServer::~OnvifServer() {
  is_over_ = true;
  thread_.join();
}

void OnvifServer::run() {
  while (!is_over_) {
    std::vector<pollfd> all{{listening_.get(), POLLIN, 0}};
    for (const Connection& one : connections_) all.push_back({one.socket.get(), POLLIN, 0});
    constexpr int tick = 2;  // ms
    if (::poll(all.data(), all.size(), tick) > 0) {
      auto event = std::next(all.begin());
      for (Connection& one : connections_)
        if ((event++)->revents != 0) take(one);
      if (all.front().revents != 0) accept();
    }
    for (Connection& one : connections_) send(one);
    std::erase_if(connections_, [](const Connection& one) { return one.is_over; });
  }
}

void OnvifServer::accept() {
  Descriptor made(::accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (made) connections_.push_back({std::move(made), OnvifStream(device_), {}});
}

void OnvifServer::take(Connection& one) {
  std::array<char, 4096> bytes{};
  const ssize_t got = ::recv(one.socket.get(), bytes.data(), bytes.size(), 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {
    one.is_over = true;
    return;
  }
  const std::scoped_lock lock(mutex_);
  std::ranges::move(
      one.stream.receive(std::string_view(bytes.data(), static_cast<std::size_t>(got)), steady_seconds()),
      std::back_inserter(one.waiting));
}

void OnvifServer::send(Connection& one) {
  const double now = steady_seconds();
  while (!one.is_over && !one.waiting.empty() && one.waiting.front().at <= now) {
    OnvifChunk& next = one.waiting.front();
    const ssize_t sent = ::send(one.socket.get(), next.bytes.data(), next.bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (sent < 0) {
      one.is_over = true;
      return;
    }
    next.bytes.erase(0, static_cast<std::size_t>(sent));
    if (!next.bytes.empty()) return;
    one.is_over = next.closes;
    one.waiting.erase(one.waiting.begin());
  }
}

}  // namespace flexura
