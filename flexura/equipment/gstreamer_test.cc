#include <gtest/gtest.h>

#include <string>

#include "tests/support/rtsp_camera.h"

namespace flexura {
namespace {

TEST(GStreamerCamera, DeliversEveryFrameOfANetworkCamera) {
  for (const std::string encoding : {"raw", "jpeg"}) {
    SCOPED_TRACE(encoding);
    RtspCamera peer(encoding);
    const WallClock clock;
    const auto opened = open_gstreamer_camera(peer.config(), rtsp_camera_config(), clock);
    const auto frames = next_frames(*opened.value(), 60);
    ASSERT_EQ(frames.size(), 60U);
    expect_in_order(frames);
    expect_true_numbers(frames);
    EXPECT_EQ(opened.value()->counts().lost, 0);
    EXPECT_EQ(opened.value()->counts().connections, 1);
  }
}

TEST(GStreamerCamera, CountsFramesWithLostPackets) {
  RtspCamera peer("lossy");
  const WallClock clock;
  const auto opened = open_gstreamer_camera(peer.config(), rtsp_camera_config(), clock);
  const auto frames = next_frames(*opened.value(), 60);
  ASSERT_EQ(frames.size(), 60U);
  expect_in_order(frames);
  expect_true_numbers(frames);
  EXPECT_GT(opened.value()->counts().lost, 0);
}

TEST(GStreamerCamera, ComesBackAfterTheServersDeath) {
  RtspCamera peer("raw");
  const WallClock clock;
  const auto opened = open_gstreamer_camera(peer.config(), rtsp_camera_config(), clock);
  auto frames = next_frames(*opened.value(), 3);
  ASSERT_EQ(frames.size(), 3U);
  peer.program.kill();
  const std::string fault = next_fault(*opened.value());
  EXPECT_NE(fault.find("camera \"left\": rtsp://127.0.0.1:"), std::string::npos) << fault;
  EXPECT_EQ(fault.find('\n'), std::string::npos);
  const RtspCamera again("raw", peer.port);
  ASSERT_EQ(again.port, peer.port);
  const auto later = next_frames(*opened.value(), 3);
  ASSERT_EQ(later.size(), 3U);
  frames.insert(frames.end(), later.begin(), later.end());
  expect_in_order(frames);
  EXPECT_EQ(opened.value()->counts().connections, 2);
}

TEST(GStreamerCamera, RunsPipelinesInGrayAndColor) {
  const WallClock clock;
  CameraConfig camera = rtsp_camera_config();
  camera.sensor.pixels = PixelKind::color;
  const GStreamerConfig red{
      .source = "videotestsrc is-live=true pattern=red ! video/x-raw,width=320,height=240,framerate=30/1"};
  const auto opened = open_gstreamer_camera(red, camera, clock);
  const auto frames = next_frames(*opened.value(), 3);
  ASSERT_EQ(frames.size(), 3U);
  const auto& image = std::get<Image<std::uint8_t>>(*frames[0].picture);
  ASSERT_EQ(image.channels(), 3);
  EXPECT_GT(image.at(319, 239, 0), 250);
  EXPECT_LT(image.at(319, 239, 1), 5);
}

TEST(GStreamerCamera, SaysWhenARecordingHasEnded) {
  const WallClock clock;
  const GStreamerConfig recording{
      .source = "videotestsrc num-buffers=5 ! video/x-raw,width=320,height=240,framerate=30/1"};
  const auto opened = open_gstreamer_camera(recording, rtsp_camera_config(), clock);
  const std::string fault = next_fault(*opened.value());
  EXPECT_NE(fault.find("the recording has ended"), std::string::npos) << fault;
  EXPECT_EQ(opened.value()->counts().frames, 5);
}

std::string fault_of(const std::string& source, const CameraConfig& camera, double silence = 30) {
  const WallClock clock;
  const auto opened = open_gstreamer_camera({.source = source, .silence = silence}, camera, clock);
  return opened ? next_fault(*opened.value()) : text(*opened.fault());
}

TEST(GStreamerCamera, NamesWhatIsWrong) {
  const CameraConfig camera = rtsp_camera_config();
  EXPECT_NE(fault_of("nosuchsource ! videoconvert", camera).find("no element \"nosuchsource\""),
            std::string::npos);
  EXPECT_NE(fault_of("videotestsrc is-live=true ! video/x-raw,width=64,height=48", camera)
                .find("the stream has 64 x 48 pixels, the file's sensor has 320 x 240"),
            std::string::npos);
  // Port 9 (discard) is closed on test machines. Passwords are not shown.
  const std::string unreachable = fault_of("rtsp://user:secret@127.0.0.1:9/", camera);
  EXPECT_NE(unreachable.find("rtsp://127.0.0.1:9/"), std::string::npos) << unreachable;
  EXPECT_EQ(unreachable.find("secret"), std::string::npos) << unreachable;
  EXPECT_NE(fault_of("appsrc is-live=true caps=video/x-raw,format=GRAY8,width=320,height=240", camera, 0.5)
                .find("no frame for 0.5 s"),
            std::string::npos);
  CameraConfig deep = camera;
  deep.sensor.bits = 12;
  EXPECT_NE(fault_of("videotestsrc", deep).find("8 bits"), std::string::npos);
}

}  // namespace
}  // namespace flexura
