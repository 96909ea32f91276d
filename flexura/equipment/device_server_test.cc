#include "flexura/equipment/device_server.h"

#include <gtest/gtest.h>

#include <string>

#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

constexpr double server_patience = 20;  // s

class Echo : public ServedDevice {
 public:
  std::vector<std::string> receive(std::string_view bytes, double) override {
    heard += bytes;
    return {std::string(bytes)};
  }
  std::vector<std::string> advance(double) override { return {}; }
  std::string heard;
};

std::string read_some(Link& link, std::size_t size) {
  std::string bytes;
  for (const double start = steady_seconds();
       bytes.size() < size && steady_seconds() < start + server_patience;)
    bytes += link.read(0.05).value();
  return bytes;
}

TEST(DeviceServer, AnswersOverASerialLineAndOverUdp) {
  Echo serial, udp;
  SerialPair pair = open_serial_pair();
  const std::string path = pair.path;
  DeviceServer on_line(std::move(pair.device), serial);
  UdpPlace place = open_udp_place();
  const std::string address = "udp:127.0.0.1:" + std::to_string(place.port);
  DeviceServer on_port(std::move(place.device), udp);
  for (const std::string& at : {path, address}) {
    auto opened = open_link(parse_link_address(at));
    ASSERT_TRUE(opened.value()->write("hello"));
    EXPECT_EQ(read_some(*opened.value(), 5), "hello");
  }
  const auto lock = on_line.lock();
  EXPECT_EQ(serial.heard, "hello");
}

TEST(DeviceServer, IsSilentOnRequest) {
  Echo echo;
  UdpPlace place = open_udp_place();
  auto opened = open_link(parse_link_address("udp:127.0.0.1:" + std::to_string(place.port)));
  DeviceServer server(std::move(place.device), echo);
  server.set_silent(true);
  ASSERT_TRUE(opened.value()->write("lost"));
  EXPECT_EQ(opened.value()->read(0.05).value(), "");
  server.set_silent(false);
  ASSERT_TRUE(opened.value()->write("heard"));
  EXPECT_EQ(read_some(*opened.value(), 5), "heard");
}

}  // namespace
}  // namespace flexura
