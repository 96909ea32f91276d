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

// Measurements in the pictures that clients see: pure functions, callable from other threads. They use only
// what is available at a real rig: pictures, and the models of arm and cameras.
namespace flexura {

/// A picture, and the camera's reading for it.
struct SeenPicture {
  std::size_t camera = 0;
  std::int64_t number = 0;                 ///< Picture number for the client.
  int white = 255;                         ///< Largest value of the picture.
  std::shared_ptr<const Picture> picture;  ///< Never null.
  CameraReading reading;                   ///< At mid-exposure.
};

/// Returns the names of the possible layers: "mask", "silhouette", "axis", "markers", "circle".
[[nodiscard]] std::span<const std::string_view> layer_names();

/// Returns the answer to `measure`: measurements of the arm in the picture, as layers of these names
/// (docs/viewer-protocol.md). The offset caused by the lens between the tube's middle in the picture and the
/// image of its backbone is corrected.
[[nodiscard]] Node measure_answer(const ViewedRig& rig, const SeenPicture& seen,
                                  const std::vector<std::string>& layers);

/// Returns the answer to `shape`: the arm's shape from pictures of two or more cameras, as poses of a ghost.
[[nodiscard]] Node shape_answer(const ViewedRig& rig, std::span<const SeenPicture> seen);

}  // namespace flexura
