#include "flexura/equipment/found_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <fstream>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/v4l2_fake.h"
#include "flexura/equipment/visca_device.h"
#include "flexura/equipment/wall_clock.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

MATCHER_P2(IsFound, place, about, "") { return arg.place == place && arg.about == about; }

void touch(const std::filesystem::path& file, const std::string& line = "") {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << line << '\n';
}

TEST(FoundDevices, AreSerialLinesWithStableNames) {
  const TemporaryFolder folder;
  const DeviceFolders folders{.devices = folder.path() / "dev", .system = folder.path() / "sys"};
  EXPECT_THAT(found_serial_lines(folders), IsEmpty()) << "a folder that is not there";
  for (const char* name : {"ttyUSB10", "ttyUSB2", "ttyACM0", "ttyS0", "tty1", "null"})
    touch(folders.devices / name);
  const auto by_id = folders.devices / "serial" / "by-id";
  std::filesystem::create_directories(by_id);
  std::filesystem::create_symlink("../../ttyUSB2", by_id / "usb-board");
  EXPECT_THAT(found_serial_lines(folders), ElementsAre(IsFound((folders.devices / "ttyACM0").string(), ""),
                                                       IsFound((folders.devices / "ttyUSB2").string(),
                                                               "also " + (by_id / "usb-board").string()),
                                                       IsFound((folders.devices / "ttyUSB10").string(), "")));
}

TEST(FoundDevices, AreCanInterfacesUpAndDown) {
  const TemporaryFolder folder;
  const DeviceFolders folders{.devices = folder.path(), .system = folder.path()};
  const auto net = folder.path() / "class" / "net";
  touch(net / "can0" / "type", "280"), touch(net / "can0" / "flags", "0x40081");
  touch(net / "can1" / "type", "280"), touch(net / "can1" / "flags", "0x40080");
  touch(net / "eth0" / "type", "1"), touch(net / "eth0" / "flags", "0x1003");
  EXPECT_THAT(
      found_can_interfaces(folders),
      ElementsAre(IsFound("can:can0", "up"),
                  IsFound("can:can1", "down; switch it on by: ip link set can1 up type can bitrate 500000")));
}

TEST(FoundDevices, AreVideoDevicesWithFormats) {
  const TemporaryFolder folder;
  const DeviceFolders folders{.devices = folder.path(), .system = folder.path()};
  touch(folder.path() / "video0"), touch(folder.path() / "video1");
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_YUYV, 640, 480);
  const auto found = found_video_devices(folders, fake);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].about, "YUYV 640 x 480");
  EXPECT_THAT(found[1].about, HasSubstr("No such file")) << "the second cannot be opened";
  EXPECT_EQ(fake->held(), 0u);
}

TEST(FoundDevices, AnswerAProbe) {
  WallClock clock;
  {
    SerialPair line = open_serial_pair();
    GrblDevice board;
    const DeviceServer server(std::move(line.device), board);
    EXPECT_THAT(probe_link(line.path, clock), HasSubstr("Grbl"));
  }
  {
    UdpPlace place = open_udp_place();
    ViscaDevice head(ViscaFraming::datagram);
    head.add({});
    const DeviceServer server(std::move(place.device), head);
    EXPECT_EQ(probe_link("udp:127.0.0.1:" + std::to_string(place.port), clock),
              "VISCA head: vendor 0020h, model 040Eh");
  }
  EXPECT_THAT(probe_link("/dev/no-such-line", clock), HasSubstr("No such file"));
  EXPECT_THROW((void)probe_link("can:can0", clock), std::invalid_argument);
  EXPECT_THROW((void)probe_link("nonsense", clock), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
