#include "flexura/equipment/video_server.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <variant>

#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

constexpr double longest_exchange = 60;  // s; only a test that hangs needs it.
constexpr int number_width = 8;          // Columns of a picture's number.

CameraConfig seen_by(PixelKind pixels, int width) {
  CameraConfig camera;
  camera.name = "front";
  camera.sensor.width = width, camera.sensor.height = 32;
  camera.sensor.pixels = pixels;
  camera.sensor.frame_rate = 50;
  return camera;
}

VideoStream stream_for(const CameraConfig& camera) {
  return {"front", static_cast<int>(camera.sensor.width), static_cast<int>(camera.sensor.height),
          camera.sensor.pixels, camera.sensor.frame_rate};
}

// Noise of all values, and the number in bits at the top left.
Image<std::uint8_t> numbered_noise(const CameraConfig& camera, unsigned number) {
  Image<std::uint8_t> picture(static_cast<int>(camera.sensor.width), static_cast<int>(camera.sensor.height),
                              camera.sensor.channels());
  std::mt19937 random(number);
  for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(random());
  for (int v = 0; v < 8; ++v)
    for (int bit = 0; bit < 16; ++bit)
      for (int channel = 0; channel < picture.channels(); ++channel)
        for (int u = 0; u < number_width; ++u)
          picture.at(number_width * bit + u, v, channel) = ((number >> bit) & 1U) != 0 ? 255 : 0;
  return picture;
}

unsigned number_of(const Image<std::uint8_t>& picture) {
  unsigned number = 0;
  for (int bit = 0; bit < 16; ++bit)
    if (picture.at(number_width * bit + 4, 4) > 127) number |= 1U << bit;
  return number;
}

// Sends numbered pictures until enough have arrived, and gives each to `check`. The stamp of picture n is
// start + n / rate, though the pictures are sent later and not evenly.
template <class Check>
void exchange(const CameraConfig& camera, const VideoServerConfig& config, const Check& check) {
  const auto server = open_video_server({stream_for(camera)}, config);
  const WallClock clock;
  auto opened = open_gstreamer_camera({.source = server->address(0)}, camera, clock);
  ASSERT_TRUE(opened) << text(*opened.fault());
  CountedCamera& port = *opened.value();
  const double rate = camera.sensor.frame_rate, start = steady_seconds();
  unsigned next = 0;
  int arrived = 0;
  while (arrived < 30 && steady_seconds() < start + longest_exchange) {
    const double stamp = start + next / rate;
    if (steady_seconds() < stamp + 0.03 + 0.01 * (next % 2)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    } else {
      server->put(0, numbered_noise(camera, next), stamp);
      ++next;
    }
    const auto taken = port.newest();
    if (!taken || !taken.value()) continue;
    check(*taken.value());
    ++arrived;
  }
  EXPECT_EQ(arrived, 30);
}

TEST(VideoServer, LosesNoValueOfRawPictures) {
  for (const PixelKind pixels : {PixelKind::gray, PixelKind::color}) {
    // 130 pixels: rows whose bytes are no multiple of 4 are padded.
    const CameraConfig camera = seen_by(pixels, 130);
    std::optional<double> first;
    exchange(camera, {}, [&](const Frame& frame) {
      const auto& picture = std::get<Image<std::uint8_t>>(*frame.picture);
      const unsigned number = number_of(picture);
      EXPECT_EQ(picture, numbered_noise(camera, number));
      // The stamps are those of the pictures; the receiver converts them between two clocks.
      const double zero = frame.time - number / camera.sensor.frame_rate;
      EXPECT_NEAR(zero, first.value_or(zero), 5e-3);
      if (!first) first = zero;
    });
  }
}

TEST(VideoServer, SendsCompressedPictures) {
  const CameraConfig camera = seen_by(PixelKind::color, 128);
  exchange(camera, {.encoding = VideoEncoding::jpeg, .quality = 95}, [&](const Frame& frame) {
    const auto& picture = std::get<Image<std::uint8_t>>(*frame.picture);
    const Image<std::uint8_t> sent = numbered_noise(camera, number_of(picture));
    EXPECT_NE(picture, sent);
    double sum = 0;
    for (int u = 0; u < number_width * 16; ++u) sum += std::abs(picture.at(u, 3) - sent.at(u, 3));
    // The noise beside the number spoils its colors a little.
    constexpr double tolerable = 30;
    EXPECT_LT(sum / (number_width * 16), tolerable);
  });
}

TEST(VideoServer, SaysWhatItCannotServe) {
  EXPECT_THROW(
      (void)open_video_server({stream_for(seen_by(PixelKind::gray, 130))}, {.encoding = VideoEncoding::jpeg}),
      std::runtime_error);
  const auto server = open_video_server({stream_for(seen_by(PixelKind::gray, 128))}, {});
  const std::string address = server->address(0);
  const auto port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
  EXPECT_THROW((void)open_video_server({stream_for(seen_by(PixelKind::gray, 128))}, {.port = port}),
               std::runtime_error);
  EXPECT_THROW(server->put(0, Image<std::uint8_t>(64, 32, 1), steady_seconds()), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
