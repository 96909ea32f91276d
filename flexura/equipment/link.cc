#include "flexura/equipment/link.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/base/descriptor.h"

namespace flexura {
namespace {

using Clock = std::chrono::steady_clock;

PortFault lost(const std::string& name, int error) {
  return {FaultKind::link_lost, fmt::format("{}: {}", name, std::strerror(error))};
}

// Waits for an event, for at most `timeout` s. Returns 0 if it did not happen.
short wait_for(int descriptor, short event, double timeout) {
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout));
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    pollfd one{descriptor, event, 0};
    const int ready = ::poll(&one, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready > 0) return one.revents;
    if (ready == 0 || errno != EINTR) return 0;
  }
}

class DescriptorLink : public Link {
 public:
  DescriptorLink(Descriptor descriptor, std::string name, double write_timeout)
      : descriptor_(std::move(descriptor)), name_(std::move(name)), write_timeout_(write_timeout) {
    if (!std::isfinite(write_timeout) || write_timeout <= 0)
      throw std::invalid_argument("a link's write timeout must be finite and above 0");
    const int flags = ::fcntl(descriptor_.get(), F_GETFL);
    if (flags < 0 || ::fcntl(descriptor_.get(), F_SETFL, flags | O_NONBLOCK) < 0)
      throw std::invalid_argument(fmt::format("{}: {}", name_, std::strerror(errno)));
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] int descriptor() const override { return descriptor_.get(); }

  CommandOutcome write(std::string_view bytes) override {
    const std::scoped_lock lock(writing_);
    const auto end = Clock::now() + std::chrono::duration<double>(write_timeout_);
    while (!bytes.empty()) {
      const ssize_t sent = send_or_write(descriptor_.get(), bytes);
      if (sent >= 0) {
        bytes.remove_prefix(static_cast<std::size_t>(sent));
      } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
        const double left = std::chrono::duration<double>(end - Clock::now()).count();
        if (left <= 0)
          return PortFault{FaultKind::link_lost,
                           fmt::format("{}: the device accepted no bytes for {:g} s", name_, write_timeout_)};
        (void)wait_for(descriptor_.get(), POLLOUT, left);
      } else if (errno == ENOBUFS) {
        // The queue of a CAN interface is full, often with only 10 frames. The socket is writable all the
        // same.
        if (std::chrono::duration<double>(end - Clock::now()).count() <= 0)
          return PortFault{
              FaultKind::link_lost,
              fmt::format("{}: the bus accepted no frames for {:g} s; are its speed, its wiring and its "
                          "terminators right, and is a device switched on?",
                          name_, write_timeout_)};
        (void)::poll(nullptr, 0, 1);
      } else if (errno != EINTR) {
        return lost(name_, errno);
      }
    }
    return Accepted{};
  }

  Outcome<std::string> read(double timeout) override {
    if (!std::isfinite(timeout) || timeout < 0)
      throw std::invalid_argument("the timeout of a read must be finite and not negative");
    if (wait_for(descriptor_.get(), POLLIN, timeout) == 0) return std::string();
    std::string bytes(std::size_t{1} << 16, '\0');
    const ssize_t got = ::read(descriptor_.get(), bytes.data(), bytes.size());
    if (got < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return std::string();
      return lost(name_, errno);
    }
    if (got == 0 && is_stream())
      return PortFault{FaultKind::link_lost, name_ + ": the device closed the connection"};
    bytes.resize(static_cast<std::size_t>(got));
    return bytes;
  }

 private:
  [[nodiscard]] bool is_stream() const {
    int type = SOCK_STREAM;
    socklen_t size = sizeof type;
    return ::getsockopt(descriptor_.get(), SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type == SOCK_STREAM;
  }
  static ssize_t send_or_write(int descriptor, std::string_view bytes) {
    // A write to a closed socket must not end the program by a signal.
    const ssize_t sent = ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent >= 0 || errno != ENOTSOCK) return sent;
    return ::write(descriptor, bytes.data(), bytes.size());
  }

  Descriptor descriptor_;
  std::string name_;
  double write_timeout_;
  std::mutex writing_;
};

// Returns the number in `text`, or std::nullopt.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

constexpr std::array<std::pair<std::int64_t, speed_t>, 15> speeds{{{1200, B1200},
                                                                   {2400, B2400},
                                                                   {4800, B4800},
                                                                   {9600, B9600},
                                                                   {19200, B19200},
                                                                   {38400, B38400},
                                                                   {57600, B57600},
                                                                   {115200, B115200},
                                                                   {230400, B230400},
                                                                   {460800, B460800},
                                                                   {500000, B500000},
                                                                   {921600, B921600},
                                                                   {1000000, B1000000},
                                                                   {1500000, B1500000},
                                                                   {2000000, B2000000}}};

std::optional<speed_t> speed_of(std::int64_t baud) {
  const auto* const found = std::ranges::find(speeds, baud, &std::pair<std::int64_t, speed_t>::first);
  if (found == speeds.end()) return std::nullopt;
  return found->second;
}

// Makes a terminal pass all bytes unchanged.
bool make_raw(int descriptor, speed_t speed) {
  termios line{};
  if (::tcgetattr(descriptor, &line) != 0) return false;
  ::cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  line.c_cc[VMIN] = 1, line.c_cc[VTIME] = 0;
  return ::cfsetispeed(&line, speed) == 0 && ::cfsetospeed(&line, speed) == 0 &&
         ::tcsetattr(descriptor, TCSANOW, &line) == 0;
}

Outcome<std::unique_ptr<Link>> open_serial(const LinkAddress& address, double write_timeout) {
  const std::optional<speed_t> speed = speed_of(address.baud);
  if (!speed) throw std::invalid_argument(fmt::format("no serial line has {} bits per second", address.baud));
  Descriptor line(::open(address.place.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!line) return lost(address.place, errno);
  if (::isatty(line.get()) == 0)
    return PortFault{FaultKind::link_lost, address.place + ": this is not a serial line"};
  if (::ioctl(line.get(), TIOCEXCL) != 0 || !make_raw(line.get(), *speed)) return lost(address.place, errno);
  ::tcflush(line.get(), TCIOFLUSH);
  return adopt_link(std::move(line), address.place, write_timeout);
}

// Connects within `timeout` s. Returns 0 or an error number.
int connect_within(int socket, const addrinfo& to, double timeout) {
  if (::connect(socket, to.ai_addr, to.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (wait_for(socket, POLLOUT, timeout) == 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

Outcome<std::unique_ptr<Link>> open_socket(const LinkAddress& address, double write_timeout) {
  addrinfo hints{};
  hints.ai_socktype = address.kind == LinkAddress::Kind::tcp ? SOCK_STREAM : SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int problem =
      ::getaddrinfo(address.place.c_str(), std::to_string(address.port).c_str(), &hints, &found);
  if (problem != 0)
    return PortFault{FaultKind::link_lost, fmt::format("{}: {}", address.place, ::gai_strerror(problem))};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
  int error = EADDRNOTAVAIL;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    Descriptor made(
        ::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol));
    if (!made) {
      error = errno;
      continue;
    }
    error = connect_within(made.get(), *one, write_timeout);
    if (error != 0) continue;
    if (address.kind == LinkAddress::Kind::tcp) {
      // Commands are short and urgent.
      const int yes = 1;
      (void)::setsockopt(made.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    }
    return adopt_link(std::move(made), text(address), write_timeout);
  }
  return lost(text(address), error);
}

// Returns the reason why an interface cannot be used, or "".
std::string can_problem(int socket, const std::string& place, ifreq& interface) {
  if (place.size() >= sizeof interface.ifr_name) return "no interface has such a long name";
  std::ranges::copy(place, std::begin(interface.ifr_name));
  if (::ioctl(socket, SIOCGIFFLAGS, &interface) != 0) return "this machine has no such network interface";
  if ((interface.ifr_flags & IFF_UP) == 0)
    return fmt::format("the interface is down; switch it on by: ip link set {} up type can bitrate 500000",
                       place);
  return ::ioctl(socket, SIOCGIFINDEX, &interface) != 0 ? std::strerror(errno) : "";
}

Outcome<std::unique_ptr<Link>> open_can(const LinkAddress& address, double write_timeout) {
  Descriptor made(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!made)
    return PortFault{FaultKind::link_lost,
                     fmt::format("{}: the kernel has no CAN sockets ({}); load the modules can and can_raw",
                                 text(address), std::strerror(errno))};
  ifreq interface{};
  if (const std::string problem = can_problem(made.get(), address.place, interface); !problem.empty())
    return PortFault{FaultKind::link_lost, fmt::format("{}: {}", text(address), problem)};
  const can_err_mask_t errors =
      CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_ACK | CAN_ERR_BUSOFF | CAN_ERR_BUSERROR | CAN_ERR_RESTARTED;
  (void)::setsockopt(made.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
  sockaddr_can at{};
  at.can_family = AF_CAN, at.can_ifindex = interface.ifr_ifindex;
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
    return PortFault{FaultKind::link_lost, fmt::format("{}: {}", text(address), std::strerror(errno))};
  return adopt_link(std::move(made), text(address), write_timeout);
}

}  // namespace

LinkAddress parse_link_address(std::string_view text) {
  LinkAddress address;
  const auto refuse = [&](std::string_view why) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is not an address of a device: {}; expected a path such as /dev/ttyUSB0 or "
                    "/dev/ttyUSB0@9600, tcp:HOST:PORT, udp:HOST:PORT or can:INTERFACE",
                    text, why));
  };
  if (text.starts_with('/')) {
    const std::size_t at = text.rfind('@');
    address.place = text.substr(0, at);
    if (at != std::string_view::npos) {
      const std::optional<std::int64_t> baud = number_in<std::int64_t>(text.substr(at + 1));
      if (!baud || !speed_of(*baud)) refuse("no serial line has this speed");
      address.baud = *baud;
    }
    if (address.place.find('\0') != std::string::npos) refuse("a path must not contain a zero byte");
    return address;
  }
  if (text.starts_with("can:")) {
    address.kind = LinkAddress::Kind::can;
    address.place = text.substr(4);
    if (address.place.empty() || address.place.size() >= IFNAMSIZ ||
        address.place.find_first_of(std::string_view("/: \t\n\0", 6)) != std::string::npos)
      refuse("an interface has a name of 1 to 15 characters, such as can0");
    return address;
  }
  if (!text.starts_with("tcp:") && !text.starts_with("udp:")) refuse("unknown kind");
  address.kind = text.starts_with("tcp:") ? LinkAddress::Kind::tcp : LinkAddress::Kind::udp;
  const std::string_view rest = text.substr(4);
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos) refuse("the port is missing");
  const std::optional<std::uint16_t> port = number_in<std::uint16_t>(rest.substr(colon + 1));
  if (!port || *port == 0) refuse("a port is a number from 1 to 65535");
  address.port = *port;
  std::string_view host = rest.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    refuse("an IPv6 address must be in brackets");
  }
  if (host.empty() || host.find_first_of(std::string_view("[]\0", 3)) != std::string_view::npos)
    refuse("the host is missing");
  address.place = host;
  return address;
}

std::string text(const LinkAddress& address) {
  if (address.kind == LinkAddress::Kind::serial) return fmt::format("{}@{}", address.place, address.baud);
  if (address.kind == LinkAddress::Kind::can) return "can:" + address.place;
  const bool is_number = address.place.find(':') != std::string::npos;
  return fmt::format("{}:{}{}{}:{}", address.kind == LinkAddress::Kind::tcp ? "tcp" : "udp",
                     is_number ? "[" : "", address.place, is_number ? "]" : "", address.port);
}

Outcome<std::unique_ptr<Link>> open_link(const LinkAddress& address, double write_timeout) {
  if (address.kind == LinkAddress::Kind::serial) return open_serial(address, write_timeout);
  if (address.kind == LinkAddress::Kind::can) return open_can(address, write_timeout);
  return open_socket(address, write_timeout);
}

std::unique_ptr<Link> adopt_link(Descriptor descriptor, std::string name, double write_timeout) {
  return std::make_unique<DescriptorLink>(std::move(descriptor), std::move(name), write_timeout);
}

SerialPair open_serial_pair() {
  Descriptor device(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  std::array<char, 128> path{};
  if (!device || ::grantpt(device.get()) != 0 || ::unlockpt(device.get()) != 0 ||
      ::ptsname_r(device.get(), path.data(), path.size()) != 0 || !make_raw(device.get(), B115200))
    throw std::runtime_error(fmt::format("no pseudoterminal: {}", std::strerror(errno)));
  // While no other end is open, a read would fail. Keeping one open here makes it wait instead.
  Descriptor kept(::open(path.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!kept) throw std::runtime_error(fmt::format("no pseudoterminal: {}", std::strerror(errno)));
  return {adopt_link(std::move(device), path.data()), path.data(), std::move(kept)};
}

}  // namespace flexura
