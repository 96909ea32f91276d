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

// A silent program may go on; its devices are stopped again until then, but not for ever.
constexpr int most_repeats = 1000, repeats_of_lost = 4;
constexpr double between_repeats = 0.2;  // s

double seconds_now() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Gives the watch its time, its messages and its connections.
class Process : public GuardWatch {
 public:
  Process(int socket, double period) noexcept : GuardWatch(period), socket_(socket) {}

  void run() noexcept {
    while (!is_over()) {
      const double now = seconds_now();
      if (advance(now)) answer(GuardAnswer::stopped);
      if (wait(wait_ms(now))) take_message();
    }
    // Devices that must brake before the rest of the messages get their time, and connections too.
    while (due() != HUGE_VAL || next_timeout() != HUGE_VAL) {
      (void)advance(seconds_now());
      (void)wait(1);
    }
  }

 private:
  // To the address of a device, while a stop is sent.
  struct Connection {
    int socket = -1;
    double until = 0;  // When it is given up, s.
    bool is_sent = false;
    const GuardMessage* stop = nullptr;
  };
  static constexpr double most_connection = 2;  // s

  // Waits at most `ms` for messages and connections; -1: for ever. Returns whether there is a message.
  bool wait(int ms) noexcept {
    std::array<pollfd, Guard::most_links + 1> all{};
    all[0] = {is_over() ? -1 : socket_, POLLIN, 0};
    for (std::size_t i = 0; i < connection_.size(); ++i)
      all[i + 1] = {connection_[i].socket, static_cast<short>(connection_[i].is_sent ? POLLIN : POLLOUT), 0};
    const bool is_ready = ::poll(all.data(), all.size(), ms) > 0;
    const double now = seconds_now();
    for (std::size_t i = 0; i < connection_.size(); ++i) {
      Connection& one = connection_[i];
      if (one.socket < 0) continue;
      const int events = is_ready ? all[i + 1].revents : 0;
      if (!one.is_sent && (events & POLLOUT) != 0) {
        const char* text = one.stop->text.data();
        for (std::size_t k = 0; k < one.stop->first; text += one.stop->sizes[k++])
          send_stop(one.socket, text, one.stop->sizes[k]);
        one.is_sent = true;
      } else if (events != 0 || now > one.until) {
        ::close(one.socket);
        one.socket = -1;
      }
    }
    return is_ready && all[0].revents != 0;
  }

  // A connection in progress is not interrupted by a repetition.
  void send_to_address(std::size_t device, const GuardMessage& stop) noexcept override {
    Connection& one = connection_[device];
    if (one.socket >= 0) return;
    one = {::socket(stop.address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0),
           seconds_now() + most_connection, false, &stop};
    [[maybe_unused]] const int begun =  // It goes on while this process does other things.
        ::connect(one.socket, reinterpret_cast<const sockaddr*>(&stop.address), stop.address_size);
  }

  // Returns the time at which a connection is given up, s; HUGE_VAL without a connection.
  [[nodiscard]] double next_timeout() const noexcept {
    double next = HUGE_VAL;
    for (const Connection& one : connection_)
      if (one.socket >= 0) next = std::min(next, one.until);
    return next;
  }

  // Waits at most until something is due; -1: for ever.
  [[nodiscard]] int wait_ms(double now) const noexcept {
    const double next = std::min(due(), next_timeout());
    if (next == HUGE_VAL) return -1;
    return static_cast<int>(std::clamp(std::ceil(1000 * (next - now)), 0.0, 60000.0));
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
      lose_program(seconds_now());
      return;
    }
    int link = -1;
    if (const cmsghdr* with = CMSG_FIRSTHDR(&head); with != nullptr && with->cmsg_type == SCM_RIGHTS)
      std::memcpy(&link, CMSG_DATA(with), sizeof link);
    heed(message, link, seconds_now());
    if (message.kind == GuardMessage::Kind::protect) answer(GuardAnswer::ready);
  }

  void send(int link, const char* bytes, std::size_t size) noexcept override { send_stop(link, bytes, size); }

  int socket_;
  std::array<Connection, Guard::most_links> connection_{};  // By the device's number.
};

}  // namespace

bool GuardWatch::advance(double now) noexcept {
  const bool is_silent = is_moving_ && now > beat_ + period_;
  if (is_silent) {
    is_moving_ = false;
    repeats_ = most_repeats;
    stop(now);
  } else if (now >= next_repeat()) {
    --repeats_;
    stop(now);
  }
  send_rest(now);
  return is_silent;
}

// Returns the time of the next repetition of a stop, s; HUGE_VAL: none. Messages with a delay come before it.
double GuardWatch::next_repeat() const noexcept {
  if (repeats_ == 0 || has_rest_) return HUGE_VAL;
  double longest = 0;
  for (std::size_t i = 0; i < devices_; ++i) longest = std::max(longest, device_[i].stop.delay);
  return stopped_ + longest + between_repeats;
}

double GuardWatch::due() const noexcept {
  double due = std::min(is_moving_ ? beat_ + period_ : HUGE_VAL, next_repeat());
  if (has_rest_)
    for (std::size_t i = 0; i < devices_; ++i)
      if (is_rest_due_[i]) due = std::min(due, stopped_ + device_[i].stop.delay);
  return due;
}

void GuardWatch::heed(const GuardMessage& message, int link, double now) noexcept {
  using Kind = GuardMessage::Kind;
  switch (message.kind) {
    case Kind::protect:
      if (devices_ < device_.size() && (link >= 0 || message.address_size > 0))
        device_[devices_++] = {link, message};
      break;
    case Kind::renew:
      if (message.device < devices_) {
        GuardMessage& own = device_[message.device].stop;
        own.first = message.first, own.count = message.count;
        own.sizes = message.sizes, own.text = message.text;
      }
      break;
    case Kind::moving:
      is_moving_ = true, beat_ = now, repeats_ = 0;
      break;
    case Kind::resting:
      is_moving_ = false, repeats_ = 0;
      break;
    case Kind::stop:
      stop(now);
      break;
    case Kind::end:
      is_over_ = true, is_moving_ = false, repeats_ = 0;
      break;
  }
}

void GuardWatch::lose_program(double now) noexcept {
  is_over_ = true, is_moving_ = false;
  repeats_ = repeats_of_lost;
  stop(now);
}

void GuardWatch::stop(double now) noexcept {
  for (std::size_t i = 0; i < devices_; ++i) {
    if (device_[i].stop.address_size > 0) {
      send_to_address(i, device_[i].stop);
      continue;
    }
    send_part(i, 0, device_[i].stop.first);
    is_rest_due_[i] = device_[i].stop.count > device_[i].stop.first;
    has_rest_ = has_rest_ || is_rest_due_[i];
  }
  stopped_ = now;
}

void GuardWatch::send_rest(double now) noexcept {
  if (!has_rest_) return;
  has_rest_ = false;
  for (std::size_t i = 0; i < devices_; ++i) {
    if (!is_rest_due_[i]) continue;
    if (now < stopped_ + device_[i].stop.delay) {
      has_rest_ = true;
      continue;
    }
    is_rest_due_[i] = false;
    send_part(i, device_[i].stop.first, device_[i].stop.count);
  }
}

void GuardWatch::send_part(std::size_t i, std::size_t from, std::size_t to) noexcept {
  const GuardMessage& stop = device_[i].stop;
  const char* text = stop.text.data();
  for (std::size_t k = 0; k < to; text += stop.sizes[k++])
    if (k >= from) send(device_[i].link, text, stop.sizes[k]);
}

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

void guard_devices(int socket, double period) noexcept { Process(socket, period).run(); }

}  // namespace flexura
