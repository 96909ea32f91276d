#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "flexura/equipment/v4l2_camera.h"
#include "flexura/equipment/v4l2_fake.h"
#include "flexura/equipment/v4l2_head.h"
#include "flexura/equipment/v4l2_picture.h"
#include "flexura/picture/image_file.h"
#include "tests/support/numbered_frames.h"

namespace flexura {
namespace {

CameraConfig video_camera_config(PixelKind pixels = PixelKind::gray) {
  CameraConfig camera;
  camera.name = "front";
  camera.sensor.width = 32, camera.sensor.height = 16;
  camera.sensor.pixels = pixels;
  return camera;
}

const Image<std::uint8_t>& bytes_of(const Frame& frame) {
  return std::get<Image<std::uint8_t>>(*frame.picture);
}

TEST(V4l2Camera, DeliversFramesWithTheDriversTimes) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 32, 16);
  fake->set_picture(std::vector<std::uint8_t>(32 * 16, 77));
  const WallClock clock;
  {
    const auto opened = open_v4l2_camera({}, video_camera_config(), clock, fake);
    const auto frames = next_frames(*opened.value(), 20);
    ASSERT_EQ(frames.size(), 20U);
    expect_in_order(frames);
    for (const Frame& frame : frames) EXPECT_NEAR(frame.time, double(frame.number) / 30, 1e-5);
    EXPECT_EQ(bytes_of(frames.back()).at(31, 15), 77);
    EXPECT_EQ(opened.value()->counts().lost, 0);
  }
  EXPECT_EQ(fake->held(), 0U);
}

TEST(V4l2Camera, CountsLostAndDamagedFrames) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 32, 16);
  const WallClock clock;
  const auto opened = open_v4l2_camera({}, video_camera_config(), clock, fake);
  ASSERT_EQ(next_frames(*opened.value(), 2).size(), 2U);
  fake->lose(3);
  ASSERT_EQ(next_frames(*opened.value(), 3).size(), 3U);
  fake->damage(2);
  const double end = steady_seconds() + camera_patience;
  while (opened.value()->counts().lost < 5 && steady_seconds() < end) (void)next_frames(*opened.value(), 1);
  EXPECT_EQ(opened.value()->counts().lost, 5);
  for (const Frame& frame : next_frames(*opened.value(), 3))
    EXPECT_NEAR(frame.time, double(frame.number) / 30, 1e-5);
}

TEST(V4l2Camera, ComesBackWhenPluggedInAgain) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 32, 16);
  const WallClock clock;
  const auto opened = open_v4l2_camera({}, video_camera_config(), clock, fake);
  ASSERT_EQ(next_frames(*opened.value(), 2).size(), 2U);
  fake->set_plugged(false);
  const std::string fault = next_fault(*opened.value());
  EXPECT_NE(fault.find("camera \"front\": /dev/video0: No such device"), std::string::npos) << fault;
  fake->set_plugged(true);
  ASSERT_EQ(next_frames(*opened.value(), 2).size(), 2U);
  EXPECT_EQ(opened.value()->counts().connections, 2);
}

TEST(V4l2Camera, ReportsSilence) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 32, 16);
  const WallClock clock;
  fake->set_silent(true);
  const auto opened = open_v4l2_camera({.silence = 0.1}, video_camera_config(), clock, fake);
  EXPECT_NE(next_fault(*opened.value()).find("no frame for 0.1 s"), std::string::npos);
  fake->set_silent(false);
  EXPECT_EQ(next_frames(*opened.value(), 1).size(), 1U);
}

TEST(V4l2Camera, SetsExposureAndGain) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 32, 16);
  fake->set_control(V4L2_CID_EXPOSURE_AUTO, {.max = 3, .value = 3, .target = 3});
  fake->set_control(V4L2_CID_EXPOSURE_ABSOLUTE, {.min = 1, .max = 1000});
  fake->set_control(V4L2_CID_GAIN, {.max = 100});
  const WallClock clock;
  {
    const auto opened = open_v4l2_camera({.exposure = 0.004, .gain = 9}, video_camera_config(), clock, fake);
    const auto frames = next_frames(*opened.value(), 1);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_NEAR(frames[0].exposure, 0.004, 1e-12);
    EXPECT_NEAR(frames[0].time, double(frames[0].number) / 30 + 0.002, 1e-5);
  }
  EXPECT_EQ(fake->control(V4L2_CID_EXPOSURE_AUTO).value, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(fake->control(V4L2_CID_EXPOSURE_ABSOLUTE).value, 40);
  EXPECT_EQ(fake->control(V4L2_CID_GAIN).value, 9);
  fake->set_control(V4L2_CID_GAIN, {.max = 100, .is_stuck = true});
  const auto stuck = open_v4l2_camera({.gain = 9}, video_camera_config(), clock, fake);
  EXPECT_NE(next_fault(*stuck.value()).find("the camera set 0 instead of gain = 9"), std::string::npos);
}

TEST(V4l2Camera, NamesWhatIsWrong) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 64, 48);
  const WallClock clock;
  const auto fault_of = [&](const V4l2Config& config, PixelKind pixels) {
    const auto opened = open_v4l2_camera(config, video_camera_config(pixels), clock, fake);
    return next_fault(*opened.value());
  };
  EXPECT_NE(fault_of({.device = "/dev/video9"}, PixelKind::gray).find("No such file"), std::string::npos);
  EXPECT_NE(fault_of({}, PixelKind::gray).find("the camera offers 64 x 48"), std::string::npos);
  EXPECT_NE(fault_of({}, PixelKind::color).find("pixels = \"color\""), std::string::npos);
  // The real calls, on a file that is no video device.
  const auto opened = open_v4l2_camera({.device = "/dev/null"}, video_camera_config(), clock);
  EXPECT_NE(next_fault(*opened.value()).find("this is no video device"), std::string::npos);
}

TEST(V4l2Picture, ConvertsYuyv) {
  // Black and white of the limited range, then the red of 100 % colour bars in ITU-R BT.601: Y 81, Cb 90, Cr
  // 240.
  const std::vector<std::uint8_t> gray = {16, 128, 235, 128}, red = {81, 90, 81, 240};
  const V4l2Layout layout{.format = V4L2_PIX_FMT_YUYV, .width = 2, .height = 1};
  const auto light = v4l2_picture(gray, layout, 1);
  EXPECT_EQ(light->at(0, 0), 0);
  EXPECT_EQ(light->at(1, 0), 255);
  const auto color = v4l2_picture(red, layout, 3);
  EXPECT_NEAR(color->at(1, 0, 0), 255, 1);
  EXPECT_NEAR(color->at(1, 0, 1), 0, 1);
  EXPECT_NEAR(color->at(1, 0, 2), 0, 1);
  // The same red in ITU-R BT.709: Y 63, Cb 102, Cr 240.
  V4l2Layout high = layout;
  high.red_share = 0.2126, high.blue_share = 0.0722;
  const auto other = v4l2_picture(std::vector<std::uint8_t>{63, 102, 63, 240}, high, 3);
  EXPECT_NEAR(other->at(1, 0, 0), 255, 1);
  EXPECT_NEAR(other->at(1, 0, 1), 0, 1);
  EXPECT_NEAR(other->at(1, 0, 2), 0, 1);
  V4l2Layout full = layout;
  full.is_full_range = true;
  EXPECT_EQ(v4l2_picture(gray, full, 1)->at(0, 0), 16);
}

TEST(V4l2Picture, ReadsRowsWithGapsAndJpeg) {
  const std::vector<std::uint8_t> rows = {1, 2, 0, 0, 3, 4};
  V4l2Layout layout{.format = V4L2_PIX_FMT_GREY, .width = 2, .height = 2, .stride = 4};
  EXPECT_EQ(v4l2_picture(rows, layout, 1)->at(1, 1), 4);
  EXPECT_EQ(v4l2_picture(rows, layout, 3)->at(1, 1, 2), 4);
  EXPECT_FALSE(v4l2_picture(std::span(rows).first(5), layout, 1));
  const std::string file = jpeg(Image<std::uint8_t>(2, 2, 1, 90));
  std::vector<std::uint8_t> bytes(file.begin(), file.end());
  layout.format = V4L2_PIX_FMT_MJPEG;
  EXPECT_NEAR(v4l2_picture(bytes, layout, 3)->at(0, 0, 1), 90, 2);
  bytes.resize(bytes.size() / 2);
  EXPECT_FALSE(v4l2_picture(bytes, layout, 3));
}

// A clock that the test sets.
class SetClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return time; }
  void wait_until(double) override {}
  double time = 0;
};

TEST(V4l2Head, MovesReadsAndHalts) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 32, 16);
  constexpr std::int32_t degree = 3600;
  fake->set_control(V4L2_CID_PAN_ABSOLUTE,
                    {.min = -90 * degree, .max = 90 * degree, .step = degree, .rate = 10 * degree});
  fake->set_control(V4L2_CID_ZOOM_ABSOLUTE, {.min = 100, .max = 500, .value = 100, .target = 100});
  const SetClock clock;
  const auto opened = V4l2Head::open({.zoom_step = 0.01}, "front", clock, fake);
  HeadPort& head = *opened.value();
  const double angle = 30 * std::numbers::pi / 180;
  ASSERT_TRUE(head.command({.pan = angle, .tilt = 0, .zoom = 2.5}));
  // Left is positive for the head, right for the control.
  EXPECT_EQ(fake->control(V4L2_CID_PAN_ABSOLUTE).target, -30 * degree);
  EXPECT_EQ(fake->control(V4L2_CID_ZOOM_ABSOLUTE).target, 250);
  EXPECT_TRUE(head.read().value().moving);
  HeadReading reading = head.read().value();
  for (int i = 0; i < 3; ++i) reading = head.read().value();
  EXPECT_FALSE(reading.moving);
  EXPECT_NEAR(reading.state.pan, angle, 1e-12);
  EXPECT_NEAR(reading.state.zoom, 2.5, 1e-12);
  ASSERT_TRUE(head.command({.pan = -2 * angle, .tilt = 0, .zoom = 2.5}));
  ASSERT_TRUE(head.halt());
  for (int i = 0; i < 3; ++i) reading = head.read().value();
  EXPECT_FALSE(reading.moving);
  EXPECT_GT(reading.state.pan, -angle);
  EXPECT_FALSE(head.command({.pan = 0, .tilt = 0.1, .zoom = 2.5}));
  EXPECT_FALSE(head.command({.pan = std::nan(""), .tilt = 0, .zoom = 2.5}));
}

TEST(V4l2Head, ReportsAnAxisThatOnlyAcceptsCommands) {
  const auto fake = std::make_shared<V4l2Fake>(V4L2_PIX_FMT_GREY, 32, 16);
  fake->set_control(V4L2_CID_TILT_ABSOLUTE, {.min = -36000, .max = 36000, .is_stuck = true});
  SetClock clock;
  const auto opened = V4l2Head::open({.patience = 1}, "front", clock, fake);
  ASSERT_TRUE(opened.value()->command({.pan = 0, .tilt = 0.1, .zoom = 1}));
  EXPECT_TRUE(opened.value()->read().value().moving);
  clock.time = 1.5;
  const auto reading = opened.value()->read();
  ASSERT_FALSE(reading);
  EXPECT_NE(text(*reading.fault()).find("head \"front\": /dev/video0: the camera's tilt is at 0"),
            std::string::npos);
  fake->set_plugged(false);
  EXPECT_EQ(opened.value()->read().fault()->kind, FaultKind::link_lost);
  EXPECT_FALSE(V4l2Head::open({}, "front", clock, fake));
}

}  // namespace
}  // namespace flexura
