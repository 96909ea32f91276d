#pragma once

namespace flexura {

/// A file of two measured cameras: one in front of the arm and one at its side.
inline constexpr const char* two_measured_cameras = R"([[camera]]
name = "front"
fx = 800.0
cx = 319.5
cy = 239.5
position = [0.0, 0.45, 1.9]
rotation = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]
[[camera]]
name = "side"
fx = 800.0
cx = 319.5
cy = 239.5
position = [-1.9, 0.45, 0.0]
rotation = [[0, 0, 1], [0, -1, 0], [1, 0, 0]]
)";

}  // namespace flexura
