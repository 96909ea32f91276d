#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <memory>
#include <string>
#include <vector>

#include "flexura/base/descriptor.h"
#include "flexura/equipment/aravis_camera.h"
#include "tests/support/numbered_frames.h"
#include "tests/support/spawned.h"

namespace flexura {

/// Aravis' GigE Vision camera in another process, on the loopback interface. It uses the ports of the
/// standard, so there is one at a time on a machine; others wait.
struct VisionCamera {
  explicit VisionCamera(const std::vector<std::string>& options = {}, const std::string& name = "GV55")
      : lock(::open("/tmp/flexura_gige_vision_test.lock", O_RDWR | O_CREAT | O_CLOEXEC, 0666)),
        serial(locked(lock, name)),
        program(arguments(options, name)) {}

  Descriptor lock;
  std::string serial;
  Spawned program;

  [[nodiscard]] AravisConfig config() const {
    return {.device = "Aravis-Fake-" + serial, .packet_socket = false};
  }

 private:
  static std::string locked(const Descriptor& file, const std::string& name) {
    ::flock(file.get(), LOCK_EX);
    return name;
  }
  static std::vector<std::string> arguments(const std::vector<std::string>& options,
                                            const std::string& name) {
    std::vector<std::string> all = {"arv-fake-gv-camera-0.8", "-i", "127.0.0.1", "-s", name};
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }
};

/// Returns a camera of 256 x 256 pixels at 25 Hz: a frame fits into the receive buffer that every system
/// grants.
[[nodiscard]] inline CameraConfig vision_camera_config() {
  CameraConfig camera;
  camera.name = "side";
  camera.sensor.width = camera.sensor.height = 256;
  camera.sensor.frame_rate = 25;
  return camera;
}

/// Expects that the frames' numbers fit the camera's counts.
inline void expect_numbers_as_counted(const std::vector<Frame>& frames, const CountedCamera& camera) {
  if (frames.empty()) return;
  const CameraCounts counts = camera.counts();
  EXPECT_LT(frames.back().number, counts.frames + counts.lost);
}

}  // namespace flexura
