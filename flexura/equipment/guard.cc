#include "flexura/equipment/guard.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "flexura/equipment/guard_process.h"

namespace flexura {
namespace {

// Sends a message, with a descriptor unless it is -1. Async-signal-safe.
bool send_message(int socket, const GuardMessage& message, int link = -1) noexcept {
  iovec place{const_cast<GuardMessage*>(&message),
              sizeof message};  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr head{};
  head.msg_iov = &place, head.msg_iovlen = 1;
  if (link >= 0) {
    head.msg_control = control.data(), head.msg_controllen = control.size();
    cmsghdr* with = CMSG_FIRSTHDR(&head);
    with->cmsg_level = SOL_SOCKET, with->cmsg_type = SCM_RIGHTS, with->cmsg_len = CMSG_LEN(sizeof link);
    std::memcpy(CMSG_DATA(with), &link, sizeof link);
  }
  return ::sendmsg(socket, &head, MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(sizeof message);
}

std::string too_many() { return fmt::format(": a guard protects at most {} devices", Guard::most_links); }

// The second process. It keeps nothing of this one open but the socket, ignores what ends this one, and is
// not in its group of processes.
[[noreturn]] void be_guard(int socket, double period) noexcept {
  ::setsid();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGTSTP, SIGUSR1, SIGUSR2})
    ::signal(signal, SIG_IGN);
  sigset_t none{};
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  if (::dup2(socket, 0) == 0) {
    ::close_range(1, ~0U, 0);
    guard_devices(0, period);
  }
  ::_exit(0);
}

}  // namespace

GuardMessage guard_message(const StopMessages& stop, const std::string& name) {
  GuardMessage message;
  message.kind = GuardMessage::Kind::protect;
  const std::size_t count = stop.first.size() + stop.then.size();
  if (count > Guard::most_messages)
    throw std::invalid_argument(
        fmt::format("{}: a device has at most {} stop messages", name, Guard::most_messages));
  if (!std::isfinite(stop.delay) || stop.delay < 0)
    throw std::invalid_argument("the delay of stop messages must be finite and not negative");
  message.first = static_cast<std::uint8_t>(stop.first.size());
  message.count = static_cast<std::uint8_t>(count);
  message.delay = stop.delay;
  std::size_t used = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& text = i < stop.first.size() ? stop.first[i] : stop.then[i - stop.first.size()];
    if (text.empty() || used + text.size() > message.text.size())
      throw std::invalid_argument(
          fmt::format("{}: stop messages have 1 to {} bytes together", name, message.text.size()));
    std::ranges::copy(text, message.text.begin() + static_cast<std::ptrdiff_t>(used));
    message.sizes[i] = static_cast<std::uint16_t>(text.size());
    used += text.size();
  }
  return message;
}

Guard::Guard(double period) : period_(period) {
  if (!std::isfinite(period) || period <= 0)
    throw std::invalid_argument("the period of a guard must be finite and above 0");
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::runtime_error(
        fmt::format("the guard of the equipment cannot be started: {}", std::strerror(errno)));
  socket_ = Descriptor(ends[0]);
  const Descriptor other(ends[1]);
  child_ = ::fork();
  if (child_ < 0)
    throw std::runtime_error(
        fmt::format("the guard of the equipment cannot be started: {}", std::strerror(errno)));
  if (child_ == 0) be_guard(other.get(), period);
}

Guard::~Guard() {
  GuardMessage message;
  message.kind = GuardMessage::Kind::end;
  (void)send_message(socket_.get(), message);
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
}

void Guard::send_new(const GuardMessage& message, int link) {
  if (!send_message(socket_.get(), message, link))
    throw std::runtime_error("the guard of the equipment does not accept messages");
  for (char answer = 0; answer != static_cast<char>(GuardAnswer::ready);) {
    pollfd one{socket_.get(), POLLIN, 0};
    if (::poll(&one, 1, 5000) <= 0 || ::recv(socket_.get(), &answer, 1, 0) != 1)
      throw std::runtime_error("the guard of the equipment does not answer");
  }
}

void Guard::protect(const Link& link, const StopMessages& stop) {
  const std::scoped_lock lock(protecting_);
  if (link.descriptor() < 0) throw std::invalid_argument(link.name() + ": a guard needs an open descriptor");
  if (links_ == most_links) throw std::invalid_argument(link.name() + too_many());
  const GuardMessage message = guard_message(stop, link.name());
  send_new(message, link.descriptor());
  Protected& own = protected_[links_];
  own.descriptor = link.descriptor();
  own.count = message.first;
  own.text = message.text;
  std::ranges::copy(message.sizes, own.sizes.begin());
  ++links_;
}

std::size_t Guard::protect(const LinkAddress& address, const StopMessages& stop) {
  const std::scoped_lock lock(protecting_);
  if (address.kind != LinkAddress::Kind::tcp || !stop.then.empty())
    throw std::invalid_argument(
        text(address) + ": for a device at an address, a guard needs a TCP address and no delayed messages");
  if (links_ == most_links) throw std::invalid_argument(text(address) + too_many());
  GuardMessage message = guard_message(stop, text(address));
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int problem =
          ::getaddrinfo(address.place.c_str(), std::to_string(address.port).c_str(), &hints, &found);
      problem != 0)
    throw std::runtime_error(fmt::format("{}: {}", address.place, ::gai_strerror(problem)));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
  std::memcpy(&message.address, found->ai_addr, found->ai_addrlen);
  message.address_size = found->ai_addrlen;
  send_new(message, -1);
  return links_++;
}

void Guard::renew(std::size_t number, const StopMessages& stop) {
  const std::scoped_lock lock(protecting_);
  if (number >= links_ || protected_[number].descriptor >= 0 || !stop.then.empty())
    throw std::invalid_argument(
        "a guard renews only the messages of a device at an address, and no delayed messages");
  GuardMessage message = guard_message(stop, "guard");
  message.kind = GuardMessage::Kind::renew;
  message.device = static_cast<std::uint8_t>(number);
  if (!send_message(socket_.get(), message)) throw std::runtime_error("the guard of the equipment is gone");
}

bool Guard::beat(bool is_moving) {
  const std::scoped_lock lock(protecting_);
  GuardMessage message;
  message.kind = is_moving ? GuardMessage::Kind::moving : GuardMessage::Kind::resting;
  if (!send_message(socket_.get(), message)) throw std::runtime_error("the guard of the equipment is gone");
  bool has_stopped = false;
  for (char answer = 0; ::recv(socket_.get(), &answer, 1, MSG_DONTWAIT) == 1;)
    has_stopped = has_stopped || answer == static_cast<char>(GuardAnswer::stopped);
  return !has_stopped;
}

void Guard::stop() noexcept {
  const std::size_t links = links_;
  for (std::size_t i = 0; i < links; ++i) {
    const Protected& one = protected_[i];
    const char* text = one.text.data();
    for (std::size_t k = 0; k < one.count; text += one.sizes[k++])
      if (one.descriptor >= 0) send_stop(one.descriptor, text, one.sizes[k]);
  }
  GuardMessage message;
  message.kind = GuardMessage::Kind::stop;
  (void)send_message(socket_.get(), message);
}

}  // namespace flexura
