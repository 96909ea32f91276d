#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/camera/view.h"
#include "flexura/port/camera_port.h"
#include "flexura/view/viewed_rig.h"

// What is measured in the pictures that clients look at: pure functions, which other threads call. They know
// what a program at a real rig would know: pictures, and how arm and cameras are believed to be.
namespace flexura {

/// A picture, and how the camera that took it was believed to stand.
struct SeenPicture {
  std::size_t camera = 0;
  std::int64_t number = 0;                 ///< As the client knows it.
  int white = 255;                         ///< The picture's largest value.
  std::shared_ptr<const Picture> picture;  ///< Never null.
  CameraReading reading;                   ///< In the middle of its exposure.
};

/// What can be drawn upon a picture: "mask", "silhouette", "axis", "markers", "circle".
[[nodiscard]] std::span<const std::string_view> layer_names();

/// The answer to `measure`: what the picture shows of the arm, as layers of these names
/// (docs/viewer-protocol.md). In what direction the lens leads away from the tube's middle is corrected.
[[nodiscard]] Node measure_answer(const ViewedRig& rig, const SeenPicture& seen,
                                  const std::vector<std::string>& layers);

/// The answer to `shape`: the arm's shape from pictures of two or more cameras, as a ghost's poses.
[[nodiscard]] Node shape_answer(const ViewedRig& rig, std::span<const SeenPicture> seen);

}  // namespace flexura
