// Cameras and heads of V4L2 at vivid, the kernel's virtual video driver. Runs in the virtual machine of
// run.sh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "flexura/base/names.h"
#include "flexura/equipment/v4l2_camera.h"
#include "flexura/equipment/v4l2_head.h"
#include "tests/machine/video_device.h"
#include "tests/support/numbered_frames.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr int vivid_width = 320, vivid_height = 180;
constexpr int full_bars = 1, no_text = 2, move_right_slow = 4, stand_still = 3;  // Of vivid's menus.

class Vivid : public ::testing::Test {
 protected:
  Vivid() : device_("vivid") {
    device_.set("Test Pattern", full_bars);
    device_.set("OSD Text Mode", no_text);
    device_.set("Horizontal Movement", stand_still);
    device_.set("Percentage of Dropped Buffers", 0);
    device_.set("Colorspace", srgb);
    device_.set("Quantization", 0);
    device_.set("Y'CbCr Encoding", 0);
  }

  [[nodiscard]] V4l2Config config(V4l2Format format = V4l2Format::automatic) const {
    return {.device = device_.path(), .format = format, .silence = camera_patience, .longest_pause = 0.25};
  }
  static CameraConfig camera(PixelKind pixels = PixelKind::gray, double rate = 30) {
    CameraConfig camera;
    camera.name = "front";
    camera.sensor.width = vivid_width, camera.sensor.height = vivid_height;
    camera.sensor.pixels = pixels, camera.sensor.frame_rate = rate;
    return camera;
  }
  [[nodiscard]] std::unique_ptr<CountedCamera> opened(const CameraConfig& camera,
                                                      V4l2Format format = V4l2Format::automatic) const {
    return open_v4l2_camera(config(format), camera, clock_).value();
  }
  [[nodiscard]] std::string fault_with(const V4l2Config& config, const CameraConfig& camera) const {
    const auto made = open_v4l2_camera(config, camera, clock_);
    return next_fault(*made.value());
  }

  static constexpr int smpte170m = 0, rec709 = 1, srgb = 2;  // Of vivid's menu "Colorspace".
  VideoDevice device_;
  WallClock clock_;
};

const Image<std::uint8_t>& pixels_of(const Frame& frame) {
  return std::get<Image<std::uint8_t>>(*frame.picture);
}

// Expects the eight bars of full brightness: white, yellow, cyan, green, magenta, red, blue, black.
// `shares` has the shares of red, green and blue in the brightness of a gray picture.
void expect_bars(const Frame& frame, const std::array<double, 3>& shares) {
  constexpr int tolerance = 5;  // vivid uses 1 to 254 only, and YUYV rounds.
  const auto& image = pixels_of(frame);
  ASSERT_EQ(image.width(), vivid_width);
  ASSERT_EQ(image.height(), vivid_height);
  for (int bar = 0; bar < 8; ++bar) {
    const std::array<int, 3> color = {(bar & 2) != 0 ? 0 : 255, (bar & 4) != 0 ? 0 : 255,
                                      (bar & 1) != 0 ? 0 : 255};
    for (const int v : {0, vivid_height / 2, vivid_height - 1}) {
      const int u = vivid_width * (2 * bar + 1) / 16;
      if (image.channels() == 3) {
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(image.at(u, v, c), color[static_cast<std::size_t>(c)], tolerance)
              << "bar " << bar << ", channel " << c << ", row " << v;
      } else {
        const double light = shares[0] * color[0] + shares[1] * color[1] + shares[2] * color[2];
        EXPECT_NEAR(image.at(u, v), light, tolerance) << "bar " << bar << ", row " << v;
      }
    }
  }
}

constexpr std::array<double, 3> shares_601 = {0.299, 0.587, 0.114};
constexpr std::array<double, 3> shares_709 = {0.2126, 0.7152, 0.0722};  // Of vivid's format GREY.

TEST_F(Vivid, GivesColourBarsInEachFormat) {
  for (const PixelKind pixels : {PixelKind::gray, PixelKind::color}) {
    for (const V4l2Format format : {V4l2Format::automatic, V4l2Format::yuyv, V4l2Format::rgb}) {
      SCOPED_TRACE(::testing::Message() << name_of(pixels) << ", format " << name_of(format));
      const auto made = opened(camera(pixels), format);
      const auto frames = next_frames(*made, 2);
      ASSERT_EQ(frames.size(), 2U);
      expect_bars(frames.back(), format == V4l2Format::automatic ? shares_709 : shares_601);
    }
  }
}

TEST_F(Vivid, ConvertsYuyvOfEachEncodingAndRange) {
  for (const int space : {smpte170m, rec709, srgb}) {
    for (const int range : {1, 2}) {  // Full, limited.
      SCOPED_TRACE(::testing::Message() << "colorspace " << space << ", range " << range);
      device_.set("Colorspace", space);
      device_.set("Quantization", range);
      const auto made = opened(camera(PixelKind::color), V4l2Format::yuyv);
      const auto frames = next_frames(*made, 1);
      ASSERT_EQ(frames.size(), 1U);
      expect_bars(frames.back(), shares_601);
    }
  }
}

// Returns the column at which the black bar ends and the white one begins.
int edge_in(const Frame& frame) {
  const auto& image = pixels_of(frame);
  for (int u = 0; u < vivid_width; ++u) {
    const int left = image.at((u + vivid_width - 1) % vivid_width, vivid_height / 2);
    if (image.at(u, vivid_height / 2) - left > 200) return u;
  }
  return -1;
}

// vivid moves its picture by a constant step with each frame, delivered or not. This shows a frame's number
// independently of the sequence numbers.
class MovingVivid : public Vivid {
 protected:
  MovingVivid() { device_.set("Horizontal Movement", move_right_slow); }

  // Expects that numbers agree with pictures. Returns how many numbers are missing between the frames.
  static std::int64_t expect_moved(const std::vector<Frame>& frames) {
    std::int64_t missing = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const std::int64_t count = frames[i].number - frames[i - 1].number;
      const int moved = (edge_in(frames[i]) - edge_in(frames[i - 1]) + vivid_width) % vivid_width;
      EXPECT_EQ(moved, step * count % vivid_width)
          << "from frame " << frames[i - 1].number << " to " << frames[i].number;
      EXPECT_GE(edge_in(frames[i]), 0);
      missing += count - 1;
    }
    return missing;
  }
  static constexpr std::int64_t step = 2;  // px per frame.
};

// Expects that every frame is either delivered or counted as lost. The camera may deliver while it is asked.
void expect_counted(CountedCamera& camera) {
  const double end = steady_seconds() + camera_patience;
  for (;;) {
    const CameraCounts before = camera.counts();
    const auto taken = camera.wait(1);
    if (taken && taken.value()) {
      const CameraCounts after = camera.counts();
      const bool is_only_one = after.frames == before.frames + 1;
      if (is_only_one && after.frames + after.lost == taken.value()->number + 1) return;
      if (is_only_one && steady_seconds() > end) {
        EXPECT_EQ(after.frames + after.lost, taken.value()->number + 1);
        return;
      }
    }
    ASSERT_LT(steady_seconds(), 2 * end) << "no frame";
  }
}

TEST_F(MovingVivid, NumbersAndTimesFrames) {
  const auto made = opened(camera());
  const auto frames = next_frames(*made, 40);
  ASSERT_EQ(frames.size(), 40U);
  expect_in_order(frames);
  expect_moved(frames);
  expect_counted(*made);
  // The driver's clock is this machine's monotonic clock: no frame comes from the future by more than a
  // period.
  for (const Frame& frame : frames) {
    EXPECT_LT(frame.time, clock_.start() + frame.received + 1.0 / 30);
    EXPECT_GT(frame.time, clock_.start());
  }
  const Frame &first = frames.front(), &last = frames.back();
  EXPECT_NEAR((last.time - first.time) * 30, double(last.number - first.number), 1.5);
}

TEST_F(MovingVivid, TakesTheRateOfTheFile) {
  const auto made = opened(camera(PixelKind::gray, 10));
  const auto frames = next_frames(*made, 8);
  ASSERT_EQ(frames.size(), 8U);
  expect_moved(frames);
  EXPECT_NEAR((frames.back().time - frames.front().time) * 10,
              double(frames.back().number - frames.front().number), 1.5);
}

TEST_F(MovingVivid, CountsFramesThatAreDropped) {
  const auto made = opened(camera());
  ASSERT_EQ(next_frames(*made, 2).size(), 2U);
  device_.set("Percentage of Dropped Buffers", 40);
  const auto frames = next_frames(*made, 40);
  ASSERT_EQ(frames.size(), 40U);
  expect_in_order(frames);
  EXPECT_GT(expect_moved(frames), 8);
  EXPECT_GT(made->counts().lost, 8);
  expect_counted(*made);
  EXPECT_EQ(made->counts().connections, 1);
}

TEST_F(MovingVivid, CountsDamagedFramesAsLost) {
  const auto made = opened(camera());
  std::vector<Frame> frames = next_frames(*made, 2);
  for (int i = 0; i < 5; ++i) {
    const std::int64_t lost = made->counts().lost;
    device_.set("Inject V4L2_BUF_FLAG_ERROR");
    const double end = steady_seconds() + camera_patience;
    while (made->counts().lost == lost && steady_seconds() < end)
      for (const Frame& frame : next_frames(*made, 1)) frames.push_back(frame);
    EXPECT_GT(made->counts().lost, lost);
  }
  expect_in_order(frames);
  EXPECT_GE(expect_moved(frames), 5);
  expect_counted(*made);
}

TEST_F(MovingVivid, CountsOnWhenTheSequenceNumbersWrap) {
  device_.set("Wrap Sequence Number", 1);  // The first frame then has the number 2^32 - 128.
  const auto made = opened(camera(PixelKind::gray, 60));
  std::vector<Frame> frames;
  while (frames.empty() || frames.back().number < 140) {
    const auto next = next_frames(*made, 1);
    ASSERT_EQ(next.size(), 1U);
    frames.push_back(next.front());
  }
  device_.set("Wrap Sequence Number", 0);
  EXPECT_LT(frames.back().number, 1000);
  expect_in_order(frames);
  expect_moved(frames);
  expect_counted(*made);
}

// Takes frames until the camera has connected for the `count`th time.
std::vector<Frame> frames_until_connection(CountedCamera& camera, std::int64_t count) {
  std::vector<Frame> frames;
  const double end = steady_seconds() + camera_patience;
  while (camera.counts().connections < count && steady_seconds() < end) {
    const auto taken = camera.wait(0.1);
    if (taken && taken.value()) frames.push_back(*taken.value());
  }
  EXPECT_EQ(camera.counts().connections, count);
  return frames;
}

TEST_F(Vivid, ConnectsAgainAfterADisconnection) {
  const auto made = opened(camera());
  const auto first = next_frames(*made, 2);
  ASSERT_EQ(first.size(), 2U);
  device_.set("Disconnect");
  EXPECT_THAT(next_fault(*made), ::testing::AllOf(HasSubstr("camera \"front\": " + device_.path()),
                                                  HasSubstr("No such device"), HasSubstr("trying again")));
  frames_until_connection(*made, 2);
  const auto again = next_frames(*made, 2);
  ASSERT_EQ(again.size(), 2U);
  EXPECT_GT(again.front().number, first.back().number);
  EXPECT_GT(again.front().time, first.back().time);
  expect_bars(again.back(), shares_709);
}

TEST_F(Vivid, ConnectsAgainWhenTheDeviceHasGoneAndComesBack) {
  const auto made = opened(camera());
  ASSERT_EQ(next_frames(*made, 2).size(), 2U);
  const auto order = [](const char* file) {
    std::ofstream("/sys/bus/platform/drivers/vivid/" + std::string(file)) << "vivid.0" << std::flush;
  };
  order("unbind");
  EXPECT_THAT(next_fault(*made), HasSubstr("No such device"));
  std::string fault;  // While the camera waits for its next try, its last fault stays.
  for (const double end = steady_seconds() + camera_patience;
       fault.find("No such file") == std::string::npos && steady_seconds() < end;)
    fault = next_fault(*made);
  EXPECT_THAT(fault, HasSubstr("No such file or directory: check the path, the cable"));
  order("bind");
  frames_until_connection(*made, 2);
  EXPECT_EQ(next_frames(*made, 2).size(), 2U);
}

TEST_F(Vivid, ConnectsAgainAfterErrorsOfTheStream) {
  device_.set("Inject VIDIOC_STREAMON Error");
  const auto made = opened(camera());
  EXPECT_THAT(next_fault(*made), HasSubstr("trying again"));
  ASSERT_EQ(next_frames(*made, 2).size(), 2U);
  EXPECT_EQ(made->counts().connections, 1);
  device_.set("Inject Fatal Streaming Error");
  EXPECT_THAT(next_fault(*made), HasSubstr("check its cable and its power"));
  frames_until_connection(*made, 2);
  EXPECT_EQ(next_frames(*made, 2).size(), 2U);
}

TEST_F(Vivid, SetsTheGainAndSwitchesTheAutomaticOff) {
  device_.set("Gain, Automatic", 1);
  V4l2Config with_gain = config();
  with_gain.gain = 42;
  const auto made = open_v4l2_camera(with_gain, camera(), clock_).value();
  ASSERT_EQ(next_frames(*made, 1).size(), 1U);
  EXPECT_EQ(device_.value("Gain, Automatic"), 0);
  EXPECT_EQ(device_.value("Gain"), 42);
}

TEST_F(Vivid, SaysWhatTheCameraLacks) {
  V4l2Config wrong = config();
  wrong.gain = 300;
  EXPECT_THAT(fault_with(wrong, camera()), HasSubstr("the camera set 255 instead of gain = 300"));
  wrong = config();
  wrong.exposure = 0.01;
  EXPECT_THAT(fault_with(wrong, camera()), HasSubstr("the camera's exposure cannot be set: remove exposure"));
  CameraConfig small = camera();
  small.sensor.width = 100, small.sensor.height = 100;
  EXPECT_THAT(fault_with(config(), small), HasSubstr("the camera offers 320 x 180"));
  EXPECT_THAT(fault_with(config(V4l2Format::mjpeg), camera()),
              HasSubstr("the camera has no format with 320 x 180 pixels"));
  const auto head = V4l2Head::open({.device = device_.path()}, "front", clock_);
  ASSERT_FALSE(head);
  EXPECT_THAT(head.fault()->what, HasSubstr("the camera has no absolute pan, tilt or zoom"));
}

TEST_F(Vivid, SaysThatAnotherProgramUsesTheCamera) {
  const auto first = opened(camera());
  ASSERT_EQ(next_frames(*first, 1).size(), 1U);
  EXPECT_THAT(fault_with(config(), camera()), HasSubstr("another program uses it"));
  EXPECT_EQ(next_frames(*first, 2).size(), 2U);
}

}  // namespace
}  // namespace flexura
