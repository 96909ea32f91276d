#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "flexura/equipment/gstreamer_camera.h"
#include "tests/support/checkout.h"
#include "tests/support/numbered_frames.h"
#include "tests/support/spawned.h"

namespace flexura {

/// A network camera in another process (tests/support/rtsp_peer.cc).
struct RtspCamera {
  explicit RtspCamera(const std::string& encoding, const std::string& at = "0")
      : program({built_file("bin/rtsp_peer"), at, encoding, "320", "240", "30"}) {
    const std::string line = program.line();
    if (line.starts_with("port ")) port = line.substr(5);
  }
  Spawned program;
  std::string port;

  [[nodiscard]] GStreamerConfig config() const { return {.source = "rtsp://127.0.0.1:" + port + "/"}; }
};

/// Returns a camera of 320 x 240 pixels at 30 Hz.
[[nodiscard]] inline CameraConfig rtsp_camera_config() {
  CameraConfig camera;
  camera.name = "left";
  camera.sensor.width = 320, camera.sensor.height = 240;
  return camera;
}

/// Expects that each frame's number differs from that of the first as the numbers in the pictures do.
inline void expect_true_numbers(const std::vector<Frame>& frames) {
  if (frames.empty()) return;
  for (const Frame& frame : frames)
    EXPECT_EQ(frame.number - frames[0].number, number_in(frame) - number_in(frames[0]));
}

}  // namespace flexura
