#include "flexura/equipment/link.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <limits>
#include <stdexcept>

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr double patience = 20;  // s; answers come at once, also on a busy machine.

std::string all_of(Link& link, std::size_t size) {
  std::string bytes;
  while (bytes.size() < size) {
    const std::string part = link.read(patience).value();
    if (part.empty()) break;
    bytes += part;
  }
  return bytes;
}

TEST(LinkAddress, KeepsItsParts) {
  for (const std::string_view written : {"/dev/ttyUSB0@115200", "/dev/serial/by-id/a:b@9600",
                                         "tcp:head-1.lab:5678", "udp:[fe80::1]:52381", "can:can0"})
    EXPECT_EQ(text(parse_link_address(written)), written);
  EXPECT_EQ(parse_link_address("/dev/ttyACM0").baud, 115200);
  EXPECT_EQ(parse_link_address("udp:[fe80::1]:52381").place, "fe80::1");
}

TEST(LinkAddress, RefusesOtherTexts) {
  for (const std::string_view wrong :
       {"", "ttyUSB0", "tcp:", "tcp:host", "tcp:host:", "tcp::80", "tcp:host:0", "tcp:host:65536",
        "udp:host:8x", "udp:fe80::1:80", "udp:[fe80::1:80", "/dev/ttyUSB0@0", "/dev/ttyUSB0@96oo",
        "/dev/ttyUSB0@", "serial:/dev/ttyUSB0", "tcp:a[b]:1", "can:", "can:can/0",
        "can:a-name-that-is-too-long"})
    EXPECT_THROW((void)parse_link_address(wrong), std::invalid_argument) << wrong;
}

TEST(SerialLink, CarriesAllBytesBothWays) {
  const SerialPair pair = open_serial_pair();
  auto opened = open_link(parse_link_address(pair.path));
  Link& host = *opened.value();
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  ASSERT_TRUE(host.write(bytes));
  EXPECT_EQ(all_of(*pair.device, 256), bytes);
  ASSERT_TRUE(pair.device->write(bytes));
  EXPECT_EQ(all_of(host, 256), bytes);
  EXPECT_EQ(host.read(0).value(), "");
}

TEST(SerialLink, SaysWhyItCannotBeOpened) {
  EXPECT_THAT(open_link(parse_link_address("/dev/no-such-line")).fault()->what, HasSubstr("No such file"));
  EXPECT_THAT(open_link(parse_link_address("/dev/null")).fault()->what, HasSubstr("not a serial line"));
}

TEST(SerialLink, GivesUpOnADeviceThatTakesNoBytes) {
  const SerialPair pair = open_serial_pair();
  const auto opened = open_link(parse_link_address(pair.path), 0.05);
  const CommandOutcome outcome = opened.value()->write(std::string(1 << 20, 'x'));
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.fault()->kind, FaultKind::link_lost);
}

class Listener {
 public:
  explicit Listener(int type) : socket_(::socket(AF_INET, type, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET, place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    if (::bind(socket_.get(), reinterpret_cast<sockaddr*>(&place), size) != 0 ||
        (type == SOCK_STREAM && ::listen(socket_.get(), 1) != 0) ||
        ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&place), &size) != 0)
      throw std::runtime_error("no socket");
    port_ = ntohs(place.sin_port);
  }
  [[nodiscard]] std::string port() const { return std::to_string(port_); }
  [[nodiscard]] Descriptor accept() const { return Descriptor(::accept(socket_.get(), nullptr, nullptr)); }
  [[nodiscard]] int get() const { return socket_.get(); }

 private:
  Descriptor socket_;
  int port_ = 0;
};

TEST(TcpLink, NoticesThatTheDeviceIsGone) {
  const Listener listener(SOCK_STREAM);
  auto opened = open_link(parse_link_address("tcp:127.0.0.1:" + listener.port()));
  Link& host = *opened.value();
  {
    const auto device = adopt_link(listener.accept(), "device");
    ASSERT_TRUE(device->write("hello"));
    EXPECT_EQ(all_of(host, 5), "hello");
  }
  EXPECT_THAT(host.read(patience).fault()->what, HasSubstr("closed the connection"));
}

TEST(TcpLink, SaysWhyItCannotBeOpened) {
  std::string port;
  {
    const Listener listener(SOCK_DGRAM);
    port = listener.port();
  }
  EXPECT_FALSE(open_link(parse_link_address("tcp:127.0.0.1:" + port)));
}

TEST(UdpLink, KeepsDatagramsApart) {
  const Listener listener(SOCK_DGRAM);
  auto opened = open_link(parse_link_address("udp:127.0.0.1:" + listener.port()));
  Link& host = *opened.value();
  ASSERT_TRUE(host.write("one"));
  sockaddr_in from{};
  socklen_t size = sizeof from;
  std::array<char, 8> bytes{};
  ASSERT_EQ(
      ::recvfrom(listener.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size),
      3);
  for (const std::string_view part : {"ab", "", "c"})
    ASSERT_GE(::sendto(listener.get(), part.data(), part.size(), 0, reinterpret_cast<sockaddr*>(&from), size),
              0);
  EXPECT_EQ(host.read(patience).value(), "ab");
  EXPECT_EQ(host.read(patience).value(), "");
  EXPECT_EQ(host.read(patience).value(), "c");
}

TEST(CanLink, SaysWhyItCannotBeOpened) {
  const auto opened = open_link(parse_link_address("can:nosuch0"));
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.fault()->what,
              ::testing::AnyOf(HasSubstr("no such network interface"), HasSubstr("no CAN sockets")));
}

TEST(Link, RefusesTimesThatAreNotFinite) {
  const SerialPair pair = open_serial_pair();
  EXPECT_THROW((void)pair.device->read(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW((void)pair.device->read(-1), std::invalid_argument);
  EXPECT_THROW((void)open_link(parse_link_address(pair.path), 0), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
