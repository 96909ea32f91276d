#include "flexura/equipment/device_server.h"

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
#include <utility>

#include "flexura/equipment/wall_clock.h"

namespace flexura {

DeviceServer::DeviceServer(std::unique_ptr<Link> link, ServedDevice& device, const LinkFaults& faults,
                           std::uint64_t seed)
    : link_(std::move(link)), device_(device), faults_(faults), thread_([this, seed] { run(seed); }) {}

DeviceServer::~DeviceServer() {
  is_over_ = true;
  thread_.join();
}

double DeviceServer::now() { return steady_seconds(); }

void DeviceServer::set_faults(const LinkFaults& faults) {
  const std::scoped_lock lock(mutex_);
  faults_ = faults;
}

void DeviceServer::run(std::uint64_t seed) {
  FaultyCarrier in(2 * seed), out(2 * seed + 1);
  while (!is_over_) {
    const auto heard = link_->read(0.002);
    // The other end may open the line again later.
    if (!heard) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const double time = now();
    std::vector<std::string> answers;
    {
      const std::scoped_lock lock(mutex_);
      if (heard && !heard.value().empty() && !is_silent_) in.put(heard.value(), faults_, time);
      for (const std::string& message : in.take(time))
        std::ranges::move(device_.receive(message, time), std::back_inserter(answers));
      std::ranges::move(device_.advance(time), std::back_inserter(answers));
      for (std::string& answer : answers) out.put(std::move(answer), faults_, time);
    }
    for (const std::string& answer : out.take(time))
      if (!is_silent_) (void)link_->write(answer);
  }
}

namespace {

class UdpPlaceLink : public Link {
 public:
  explicit UdpPlaceLink(Descriptor socket) : socket_(std::move(socket)) {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    const std::scoped_lock lock(mutex_);
    if (sender_.sin_port != 0 && ::sendto(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                                          reinterpret_cast<const sockaddr*>(&sender_), sizeof sender_) < 0)
      return PortFault{FaultKind::link_lost, fmt::format("{}: {}", name_, std::strerror(errno))};
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    pollfd one{socket_.get(), POLLIN, 0};
    if (::poll(&one, 1, static_cast<int>(1000 * timeout)) <= 0) return std::string();
    std::string bytes(std::size_t{1} << 16, '\0');
    sockaddr_in sender{};
    socklen_t size = sizeof sender;
    const ssize_t got = ::recvfrom(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr*>(&sender), &size);
    if (got < 0) return std::string();
    const std::scoped_lock lock(mutex_);
    sender_ = sender;
    bytes.resize(static_cast<std::size_t>(got));
    return bytes;
  }

 private:
  Descriptor socket_;
  std::string name_ = "udp";
  std::mutex mutex_;
  sockaddr_in sender_{};
};

}  // namespace

UdpPlace open_udp_place(std::uint16_t port) {
  Descriptor made(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in place{};
  place.sin_family = AF_INET, place.sin_addr.s_addr = htonl(INADDR_LOOPBACK), place.sin_port = htons(port);
  socklen_t size = sizeof place;
  if (!made || ::bind(made.get(), reinterpret_cast<const sockaddr*>(&place), size) != 0 ||
      ::getsockname(made.get(), reinterpret_cast<sockaddr*>(&place), &size) != 0)
    throw std::runtime_error(fmt::format("UDP port {}: {}", port, std::strerror(errno)));
  return {std::make_unique<UdpPlaceLink>(std::move(made)), ntohs(place.sin_port)};
}

}  // namespace flexura
