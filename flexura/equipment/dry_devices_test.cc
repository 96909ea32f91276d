#include "flexura/equipment/dry_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/equipment/onvif_head.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

RigEquipment with_onvif_head(OnvifPositions space) {
  OnvifConfig head;
  head.link = "tcp:10.0.0.1:80", head.space = space;
  head.zoom.positions = std::vector<double>{1, 10};
  RigEquipment equipment;
  equipment.camera.push_back({.name = "front",
                              .gstreamer = {},
                              .aravis = {},
                              .v4l2 = {},
                              .visca = {},
                              .onvif = head,
                              .v4l2_head = {}});
  return equipment;
}

// Moves the head of the equipment's camera from `start` to `to`. Returns the commands.
std::vector<std::string> commands_of(const RigEquipment& equipment, const HeadState& start,
                                     const HeadState& to) {
  std::vector<std::string> sent;
  DryDevices devices(equipment, {}, {start}, [&](const DryMessage& message) {
    EXPECT_EQ(message.device, "tcp:10.0.0.1:80");
    EXPECT_THAT(message.bytes, ::testing::Not(HasSubstr("Password")));
    if (!message.sent.asks) sent.push_back(message.sent.text);
  });
  const OnvifConfig& config = *equipment.camera[0].onvif;
  const auto opened = open_onvif_head(config, devices.clock(), {}, [&] { return devices.open(config); });
  EXPECT_TRUE(opened) << opened.fault()->what;
  HeadPort& head = *opened.value();
  EXPECT_NEAR(head.read().value().state.pan, start.pan, 1e-4);
  EXPECT_TRUE(head.command(to));
  while (devices.clock().now() < 60 && head.read().value().moving)
    devices.clock().wait_until(devices.clock().now() + 0.1);
  const HeadReading reading = head.read().value();
  EXPECT_FALSE(reading.moving);
  EXPECT_NEAR(reading.state.pan, to.pan, 1e-4);
  EXPECT_NEAR(reading.state.tilt, to.tilt, 1e-4);
  EXPECT_NEAR(reading.state.zoom, to.zoom, 1e-4);
  EXPECT_TRUE(head.halt());
  return sent;
}

TEST(DryDevices, ShowTheRequestsOfAnOnvifHead) {
  const HeadState start{-5 * degree, 2 * degree, 1}, to{18 * degree, -9 * degree, 5.5};
  // Positions grow to the left: -1/180 and 1/90 per degree by default.
  EXPECT_THAT(commands_of(with_onvif_head(OnvifPositions::generic), start, to),
              ElementsAre("AbsoluteMove pan -0.1, tilt -0.1, zoom 0.5", "Stop"));
  EXPECT_THAT(commands_of(with_onvif_head(OnvifPositions::degrees), start, to),
              ElementsAre("AbsoluteMove pan -18, tilt -9, zoom 0.5", "Stop"));
}

}  // namespace
}  // namespace flexura
