#include "flexura/equipment/guard_process.h"

#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>

namespace flexura {
namespace {

double seconds_now() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Device {
  int link = -1;
  GuardMessage stop;
  int connection = -1;  // To its address, while a stop is sent.
  double until = 0;     // When the connection is given up.
  bool is_sent = false;
};
constexpr double most_connection = 2;  // s

// The devices and what is due.
class Watch {
 public:
  Watch(int socket, double period) noexcept : socket_(socket), period_(period) {}

  void run() noexcept {
    while (!is_done_) {
      const double now = seconds_now();
      if (is_moving_ && now > beat_ + period_) {
        is_moving_ = false;
        stop(now);
        answer(GuardAnswer::stopped);
      }
      send_rest(now);
      if (wait(wait_ms(now))) take_message();
    }
    // Devices that must brake before the rest of the messages get their time, and connections too.
    while (has_rest_ || has_connections()) {
      send_rest(seconds_now());
      (void)wait(1);
    }
  }

 private:
  // Waits for messages and connections. Returns whether there is a message.
  bool wait(int ms) noexcept {
    std::array<pollfd, Guard::most_links + 1> all{};
    all[0] = {is_done_ ? -1 : socket_, POLLIN, 0};
    for (std::size_t i = 0; i < devices_; ++i) {
      const Device& one = device_[i];
      all[i + 1] = {one.connection, static_cast<short>(one.is_sent ? POLLIN : POLLOUT), 0};
    }
    const bool is_ready = ::poll(all.data(), devices_ + 1, ms) > 0;
    const double now = seconds_now();
    for (std::size_t i = 0; i < devices_; ++i) {
      Device& one = device_[i];
      if (one.connection < 0) continue;
      const bool has_event = is_ready && all[i + 1].revents != 0;
      if (has_event && !one.is_sent && (all[i + 1].revents & POLLOUT) != 0) {
        send(i, one.connection, 0, one.stop.first);
        one.is_sent = true;
      } else if (has_event || now > one.until) {
        ::close(one.connection);
        one.connection = -1;
      }
    }
    return is_ready && all[0].revents != 0;
  }
  [[nodiscard]] bool has_connections() const noexcept {
    return std::any_of(device_.begin(), device_.begin() + devices_,
                       [](const Device& one) { return one.connection >= 0; });
  }
  void connect(Device& device, double now) noexcept {
    if (device.connection >= 0) ::close(device.connection);
    device.connection =
        ::socket(device.stop.address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    device.until = now + most_connection, device.is_sent = false;
    (void)::connect(device.connection, reinterpret_cast<const sockaddr*>(&device.stop.address),
                    device.stop.address_size);
  }

  // Waits at most until something is due; -1: for ever.
  [[nodiscard]] int wait_ms(double now) const noexcept {
    double due = is_moving_ ? beat_ + period_ : HUGE_VAL;
    for (std::size_t i = 0; i < devices_; ++i)
      if (device_[i].connection >= 0) due = std::min(due, device_[i].until);
    if (has_rest_)
      for (std::size_t i = 0; i < devices_; ++i)
        if (is_rest_due_[i]) due = std::min(due, stopped_ + device_[i].stop.delay);
    if (due == HUGE_VAL) return -1;
    return static_cast<int>(std::clamp(std::ceil(1000 * (due - now)), 0.0, 60000.0));
  }

  // The other side may be gone.
  void answer(GuardAnswer what) const noexcept {
    const char byte = static_cast<char>(what);
    [[maybe_unused]] const ssize_t sent = ::send(socket_, &byte, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void take_message() noexcept {
    GuardMessage message;
    iovec place{&message, sizeof message};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    msghdr head{};
    head.msg_iov = &place, head.msg_iovlen = 1;
    head.msg_control = control.data(), head.msg_controllen = control.size();
    const ssize_t got = ::recvmsg(socket_, &head, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got != static_cast<ssize_t>(sizeof message)) {
      // The other side is gone without a word.
      is_done_ = true;
      stop(seconds_now());
      return;
    }
    int link = -1;
    if (const cmsghdr* with = CMSG_FIRSTHDR(&head); with != nullptr && with->cmsg_type == SCM_RIGHTS)
      std::memcpy(&link, CMSG_DATA(with), sizeof link);
    heed(message, link);
  }

  void heed(const GuardMessage& message, int link) noexcept {
    using Kind = GuardMessage::Kind;
    switch (message.kind) {
      case Kind::protect:
        if (devices_ < device_.size() && (link >= 0 || message.address_size > 0)) {
          device_[devices_].link = link;
          device_[devices_++].stop = message;
        }
        answer(GuardAnswer::ready);
        break;
      case Kind::renew:
        if (message.device < devices_) {
          GuardMessage& own = device_[message.device].stop;
          own.first = message.first, own.count = message.count;
          own.sizes = message.sizes, own.text = message.text;
        }
        break;
      case Kind::moving:
        is_moving_ = true, beat_ = seconds_now();
        break;
      case Kind::resting:
        is_moving_ = false;
        break;
      case Kind::stop:
        stop(seconds_now());
        break;
      case Kind::end:
        is_done_ = true;
        break;
    }
  }

  void stop(double now) noexcept {
    for (std::size_t i = 0; i < devices_; ++i) {
      if (device_[i].stop.address_size > 0) {
        connect(device_[i], now);
        continue;
      }
      send(i, device_[i].link, 0, device_[i].stop.first);
      is_rest_due_[i] = device_[i].stop.count > device_[i].stop.first;
      has_rest_ = has_rest_ || is_rest_due_[i];
    }
    stopped_ = now;
  }

  void send_rest(double now) noexcept {
    if (!has_rest_) return;
    has_rest_ = false;
    for (std::size_t i = 0; i < devices_; ++i) {
      if (!is_rest_due_[i]) continue;
      if (now < stopped_ + device_[i].stop.delay) {
        has_rest_ = true;
        continue;
      }
      is_rest_due_[i] = false;
      send(i, device_[i].link, device_[i].stop.first, device_[i].stop.count);
    }
  }

  void send(std::size_t i, int link, std::size_t from, std::size_t to) noexcept {
    const GuardMessage& stop = device_[i].stop;
    const char* text = stop.text.data();
    for (std::size_t k = 0; k < to; text += stop.sizes[k++])
      if (k >= from) send_stop(link, text, stop.sizes[k]);
  }

  int socket_;
  double period_;
  std::array<Device, Guard::most_links> device_{};
  std::array<bool, Guard::most_links> is_rest_due_{};
  std::size_t devices_ = 0;
  bool is_moving_ = false, is_done_ = false, has_rest_ = false;
  double beat_ = 0, stopped_ = 0;
};

}  // namespace

void send_stop(int descriptor, const char* bytes, std::size_t size) noexcept {
  const int errno_before = errno;
  (void)::tcflush(descriptor, TCOFLUSH);
  for (int tries = 0; size > 0 && tries < 20; ++tries) {
    ssize_t sent = ::send(descriptor, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == ENOTSOCK) sent = ::write(descriptor, bytes, size);
    if (sent >= 0) {
      bytes += sent, size -= static_cast<std::size_t>(sent);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      pollfd one{descriptor, POLLOUT, 0};
      (void)::poll(&one, 1, 5);
    } else if (errno == ENOBUFS) {
      (void)::poll(nullptr, 0, 1);  // The queue of a CAN interface is full.
    } else if (errno != EINTR) {
      break;
    }
  }
  errno = errno_before;
}

void guard_devices(int socket, double period) noexcept { Watch(socket, period).run(); }

}  // namespace flexura
