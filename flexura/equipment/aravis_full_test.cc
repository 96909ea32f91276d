#include <gtest/gtest.h>

#include <string>

#include "tests/support/vision_camera.h"

namespace flexura {
namespace {

TEST(AravisCamera, ComesBackAfterTheCamerasDeath) {
  VisionCamera peer;
  const WallClock clock;
  AravisConfig config = peer.config();
  config.silence = 1;
  const auto opened = open_aravis_camera(config, vision_camera_config(), clock);
  auto frames = next_frames(*opened.value(), 3);
  ASSERT_EQ(frames.size(), 3U) << next_fault(*opened.value());
  peer.program.kill();
  const std::string fault = next_fault(*opened.value());
  EXPECT_NE(fault.find("camera \"side\": Aravis-Fake-"), std::string::npos) << fault;
  peer.program.restart();
  const auto later = next_frames(*opened.value(), 3);
  ASSERT_EQ(later.size(), 3U) << next_fault(*opened.value());
  EXPECT_GT(later.front().number, frames.back().number);
  EXPECT_EQ(opened.value()->counts().connections, 2);
}

TEST(AravisCamera, DeliversForAMinuteWhatItCounts) {
  const VisionCamera peer;
  const WallClock clock;
  const auto near_one = open_aravis_camera({.device = "Fake_1"}, vision_camera_config(), clock);
  const auto far_one = open_aravis_camera(peer.config(), vision_camera_config(), clock);
  const std::vector<std::vector<Frame>> frames =
      watched({near_one.value().get(), far_one.value().get()}, 60 * 25);
  for (const auto& taken : frames) expect_in_order(taken);
  expect_numbers_as_counted(frames[0], *near_one.value());
  expect_numbers_as_counted(frames[1], *far_one.value());
  EXPECT_EQ(far_one.value()->counts().connections, 1);
  // A busy machine may lose frames, which are then counted.
  RecordProperty("lost_near", std::to_string(near_one.value()->counts().lost));
  RecordProperty("lost_far", std::to_string(far_one.value()->counts().lost));
}

}  // namespace
}  // namespace flexura
