#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/support/rtsp_camera.h"

namespace flexura {
namespace {

TEST(GStreamerCamera, DeliversForAMinuteWhatItCounts) {
  const WallClock clock;
  std::vector<std::unique_ptr<RtspCamera>> peers;
  std::vector<std::unique_ptr<CountedCamera>> cameras;
  std::vector<CountedCamera*> watched_ones;
  for (const std::string encoding : {"raw", "jpeg", "h264"}) {
    peers.push_back(std::make_unique<RtspCamera>(encoding));
    cameras.push_back(open_gstreamer_camera(peers.back()->config(), rtsp_camera_config(), clock).value());
    watched_ones.push_back(cameras.back().get());
  }
  const auto frames = watched(watched_ones, 60 * 30);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    SCOPED_TRACE(i);
    expect_in_order(frames[i]);
    expect_true_numbers(frames[i]);
    // A busy machine may lose frames, which are then counted: their numbers are true.
    RecordProperty("lost_" + std::to_string(i), std::to_string(cameras[i]->counts().lost));
    EXPECT_EQ(cameras[i]->counts().connections, 1);
  }
}

// The system may lose packets of a busy machine, and the count of lost frames is then only an estimate until
// the server reports its time.
TEST(GStreamerCamera, RunsOverUdp) {
  const WallClock clock;
  const RtspCamera peer("raw");
  GStreamerConfig config = peer.config();
  config.transport = StreamTransport::udp;
  const auto opened = open_gstreamer_camera(config, rtsp_camera_config(), clock);
  const auto frames = watched({opened.value().get()}, 300);
  expect_in_order(frames[0]);
  for (std::size_t i = 1; i < frames[0].size(); ++i)
    EXPECT_GT(number_in(frames[0][i]), number_in(frames[0][i - 1]));
}

}  // namespace
}  // namespace flexura
