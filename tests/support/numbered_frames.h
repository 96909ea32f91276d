#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/equipment/camera_feed.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {

inline constexpr double camera_patience = 60;  ///< Longest time that a test waits for anything, s.

/// Returns the number in a picture of tests/support/rtsp_peer.cc.
[[nodiscard]] inline std::int64_t number_in(const Frame& frame) {
  const auto& image = std::get<Image<std::uint8_t>>(*frame.picture);
  std::int64_t number = 0;
  for (int bit = 0; bit < 16; ++bit)
    if (image.at(16 * bit + 8, 8) > 127) number |= std::int64_t{1} << bit;
  return number;
}

/// Returns the next `count` frames, fewer if they do not arrive in time. Faults count as waiting.
[[nodiscard]] inline std::vector<Frame> next_frames(CameraPort& camera, std::size_t count) {
  std::vector<Frame> frames;
  const double end = steady_seconds() + camera_patience;
  while (frames.size() < count && steady_seconds() < end) {
    const auto taken = camera.wait(0.1);
    if (taken && taken.value()) frames.push_back(*taken.value());
  }
  return frames;
}

/// Watches cameras until each has delivered `count` frames, for at most four minutes. Returns the frames that
/// were seen of each. Faults after the first frame, and missing frames are failures.
[[nodiscard]] inline std::vector<std::vector<Frame>> watched(const std::vector<CountedCamera*>& cameras,
                                                             std::int64_t count) {
  std::vector<std::vector<Frame>> frames(cameras.size());
  const double end = steady_seconds() + 4 * camera_patience;
  const auto is_waiting = [&](const CountedCamera* camera) { return camera->counts().frames < count; };
  while (std::ranges::any_of(cameras, is_waiting) && steady_seconds() < end) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const auto taken = cameras[i]->wait(0.005);
      if (taken && taken.value()) frames[i].push_back(*taken.value());
      if (!taken && cameras[i]->counts().connections > 0) ADD_FAILURE() << text(*taken.fault());
    }
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    EXPECT_GE(cameras[i]->counts().frames, count);
    EXPECT_GT(frames[i].size(), 0U);
  }
  return frames;
}

/// Returns the next fault; "" if there is none in time.
[[nodiscard]] inline std::string next_fault(CameraPort& camera) {
  const double end = steady_seconds() + camera_patience;
  while (steady_seconds() < end) {
    const auto taken = camera.wait(0.05);
    if (!taken) return text(*taken.fault());
  }
  return "";
}

/// Expects that numbers and times of frames increase.
inline void expect_in_order(const std::vector<Frame>& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].number, frames[i - 1].number);
    EXPECT_GT(frames[i].time, frames[i - 1].time);
    EXPECT_GE(frames[i].received, frames[i - 1].received);
  }
}

}  // namespace flexura
