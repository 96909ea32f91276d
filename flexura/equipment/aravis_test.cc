#include <gtest/gtest.h>

#include <string>

#include "tests/support/vision_camera.h"

namespace flexura {
namespace {

// The library's own camera without a network.
TEST(AravisCamera, DeliversEveryFrame) {
  const WallClock clock;
  for (const PixelKind pixels : {PixelKind::gray, PixelKind::color}) {
    CameraConfig camera = vision_camera_config();
    camera.sensor.pixels = pixels;
    const auto opened =
        open_aravis_camera({.device = "Fake_1", .exposure = 0.01, .gain = 2.0}, camera, clock);
    const auto frames = next_frames(*opened.value(), 20);
    ASSERT_EQ(frames.size(), 20U);
    expect_in_order(frames);
    expect_numbers_as_counted(frames, *opened.value());
    EXPECT_NEAR(frames[0].exposure, 0.01, 1e-6);
    EXPECT_EQ(std::get<Image<std::uint8_t>>(*frames[0].picture).channels(), camera.sensor.channels());
  }
}

TEST(AravisCamera, DeliversFramesOfGigEVision) {
  const VisionCamera peer;
  const WallClock clock;
  const auto opened = open_aravis_camera(peer.config(), vision_camera_config(), clock);
  const auto frames = next_frames(*opened.value(), 20);
  ASSERT_EQ(frames.size(), 20U) << next_fault(*opened.value());
  expect_in_order(frames);
  expect_numbers_as_counted(frames, *opened.value());
}

TEST(AravisCamera, CountsFramesWithLostPackets) {
  const VisionCamera peer({"-r", "2"});
  const WallClock clock;
  const auto opened = open_aravis_camera(peer.config(), vision_camera_config(), clock);
  const auto frames = next_frames(*opened.value(), 60);
  ASSERT_EQ(frames.size(), 60U) << next_fault(*opened.value());
  expect_in_order(frames);
  expect_numbers_as_counted(frames, *opened.value());
  EXPECT_GT(opened.value()->counts().lost, 0);
}

TEST(AravisCamera, NamesWhatIsWrong) {
  const WallClock clock;
  const auto absent = open_aravis_camera({.device = "Nobody-1"}, vision_camera_config(), clock);
  const std::string not_found = next_fault(*absent.value());
  EXPECT_NE(not_found.find("camera \"side\": Nobody-1: "), std::string::npos) << not_found;
  CameraConfig wide = vision_camera_config();
  wide.sensor.width = 10000;
  const auto too_wide = open_aravis_camera({.device = "Fake_1"}, wide, clock);
  const std::string refused = next_fault(*too_wide.value());
  EXPECT_NE(refused.find("10000"), std::string::npos) << refused;
}

}  // namespace
}  // namespace flexura
