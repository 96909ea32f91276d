#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "flexura/base/degree.h"
#include "flexura/equipment/visca_device.h"
#include "flexura/equipment/visca_head.h"

// Heads over real serial lines and sockets of this machine, with threads.
namespace flexura {
namespace {

ViscaConfig visca_link_config(const std::string& link, ViscaFraming framing) {
  ViscaConfig config;
  config.bus.link = link;
  config.bus.framing = framing;
  config.bus.reply_timeout = 10;  // Nothing is lost here; a busy machine may be slow.
  return config;
}

// Several threads over a real serial line: heads move while others are halted.
TEST(ViscaLink, ThreadsShareASerialLine) {
  ViscaDevice device(ViscaFraming::stream);
  device.add({}), device.add({});
  SerialPair pair = open_serial_pair();
  const std::string path = pair.path;
  DeviceServer server(std::move(pair.device), device);
  ViscaConfig config = visca_link_config(path, ViscaFraming::stream);
  const auto bus = open_visca_bus(config.bus).value();
  EXPECT_EQ(bus->heads(), 2);
  ViscaHead first(bus, config);
  config.address = 2;
  ViscaHead second(bus, config);
  ASSERT_TRUE(first.start());
  ASSERT_TRUE(second.start());
  std::atomic<int> faults = 0;
  std::thread other([&] {
    for (int i = 0; i < 5; ++i) {
      if (!second.command({i * degree, 0, 1})) ++faults;
      if (!second.read()) ++faults;
    }
  });
  std::thread halting([&] {
    for (int i = 0; i < 5; ++i)
      if (!first.halt()) ++faults;
  });
  for (int i = 0; i < 5; ++i) {
    (void)first.command({i * degree, 0, 1});  // A halt may refuse it.
    if (!first.read()) ++faults;
  }
  other.join();
  halting.join();
  EXPECT_EQ(faults, 0);
  ASSERT_TRUE(first.halt());
  const auto lock = server.lock();
  EXPECT_FALSE(device.is_moving(0, DeviceServer::now()));
}

TEST(ViscaLink, WorksOverUdp) {
  for (const ViscaFraming framing : {ViscaFraming::datagram, ViscaFraming::sony}) {
    ViscaDevice device(framing);
    device.add({});
    UdpPlace place = open_udp_place();
    const ViscaConfig config = visca_link_config("udp:127.0.0.1:" + std::to_string(place.port), framing);
    DeviceServer server(std::move(place.device), device);
    const auto bus = open_visca_bus(config.bus).value();
    ViscaHead head(bus, config);
    ASSERT_TRUE(head.start());
    ASSERT_TRUE(head.command({2 * degree, 1 * degree, 200}));
    bool is_moving = true;
    for (int i = 0; i < 10000 && is_moving; ++i) is_moving = head.read().value().moving;
    EXPECT_FALSE(is_moving);
    EXPECT_EQ(head.counts()->pan, -29);
  }
}

// Hears everything and may be mute.
class MutableVisca : public ServedDevice {
 public:
  explicit MutableVisca(ServedDevice& inner) : inner_(inner) {}
  std::vector<std::string> receive(std::string_view bytes, double now) override {
    heard += bytes;
    return said(inner_.receive(bytes, now));
  }
  std::vector<std::string> advance(double now) override { return said(inner_.advance(now)); }
  std::string heard;
  bool is_mute = false;

 private:
  [[nodiscard]] std::vector<std::string> said(std::vector<std::string> answers) const {
    if (is_mute) answers.clear();
    return answers;
  }
  ServedDevice& inner_;
};

// A halt is sent at once while a command waits, and the command is not sent again.
TEST(ViscaLink, AHaltEndsAWaitingCommand) {
  ViscaDevice device(ViscaFraming::stream);
  device.add({});
  MutableVisca voice(device);
  SerialPair pair = open_serial_pair();
  const std::string path = pair.path;
  DeviceServer server(std::move(pair.device), voice);
  ViscaConfig config = visca_link_config(path, ViscaFraming::stream);
  config.bus.reply_timeout = 1, config.bus.tries = 20;
  const auto bus = open_visca_bus(config.bus).value();
  ViscaHead head(bus, config);
  ASSERT_TRUE(head.start());
  const auto set_mute = [&](bool is_mute) {
    const auto lock = server.lock();
    voice.is_mute = is_mute;
  };
  const auto hears = [&](const std::string& body) {
    for (;;) {
      {
        const auto lock = server.lock();
        if (voice.heard.find(visca_packet(1, body)) != std::string::npos) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  };
  set_mute(true);
  std::string why;
  std::thread commanding([&] { why = head.command({40 * degree, 20 * degree, 0}).fault()->what; });
  hears(visca_move(24, 20, -576, 288, {}));
  std::thread halting([&] { EXPECT_TRUE(head.halt()); });
  hears(visca_move_stop(24, 20));
  set_mute(false);
  halting.join();
  commanding.join();
  EXPECT_NE(why.find("replaced by a halt"), std::string::npos) << why;
  const auto lock = server.lock();
  EXPECT_FALSE(device.is_moving(0, DeviceServer::now()));
}

}  // namespace
}  // namespace flexura
