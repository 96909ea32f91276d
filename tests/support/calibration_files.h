#pragma once

#include <string>

namespace flexura {

/// Returns a file with a three-section arm with bands in three colours, two cameras of 320 x 240 px, and a
/// task that calibrates them. `truth` is inserted after the cameras.
inline std::string small_calibration(const std::string& task, const std::string& truth,
                                     const std::string& sensor = "") {
  const std::string images =
      "sensor = { width = 320, height = 240, pixels = \"color\", frame_rate = 10, psf = 0.7, read_noise = 1" +
      sensor + " }\n";
  const std::string rest =
      "lens = { fx = 400 }\nhead = { pan = { limits_deg = [-90, 90], max_rate_deg = 60, resolution_deg = "
      "0.075 }, tilt = { limits_deg = [-45, 45], max_rate_deg = 60, resolution_deg = 0.075 } }\n";
  const std::string stage =
      ", stage = { x = { limits = [-0.5, 0.5], max_rate = 0.5 }, y = { limits = [-0.5, 0.5], max_rate = 0.5 "
      "}, z = { limits = [-0.5, 0.5], max_rate = 0.5 } } }\n";
  return R"(
[arm]
kind = "spatial"
[[arm.section]]
length = 0.35
radius = 0.03
[[arm.section]]
length = 0.35
radius = 0.03
[[arm.section]]
length = 0.3
radius = 0.03
[arm.look]
bands = { per_section = 3, width = 0.03, colors = [[0.85, 0.1, 0.1], [0.1, 0.6, 0.15], [0.1, 0.2, 0.85]] }
[[camera]]
name = "front"
mount = { position = [0, 0.5, 2.5], look_at = [0, 0.5, 0])" +
         stage + images + rest + R"(
[[camera]]
name = "side"
mount = { position = [-2.5, 0.5, 0], look_at = [0, 0.5, 0])" +
         stage + images + rest + truth + "\n[[task]]\nkind = \"calibrate\"\n" + task;
}

/// Simulated truth in which the cameras differ from the model in every parameter that a guess may get wrong.
inline const char* const wrong_cameras = R"(
[[truth.camera]]
name = "front"
mount = { position = [0.25, 0.45, 2.75], look_at = [-0.1, 0.55, 0], roll_deg = 1 }
lens = { fx = 424, cx = 163, cy = 122 }
[[truth.camera]]
name = "side"
mount = { position = [-2.3, 0.6, 0.3], look_at = [0, 0.4, 0.1], roll_deg = -1 }
lens = { fx = 380, cx = 156, cy = 118 }
)";

}  // namespace flexura
