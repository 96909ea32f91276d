#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/camera/view.h"
#include "flexura/port/camera_port.h"
#include "flexura/view/seeing_choice.h"
#include "flexura/view/viewed_rig.h"
#include "flexura/vision/picture_file.h"

// Measurements in the pictures that clients see. All functions are pure and callable from any thread. They
// use only data that a real rig provides: pictures, and the models of arm and cameras.
namespace flexura {

/// A picture, and the camera's axis positions when it was taken.
struct SeenPicture {
  std::size_t camera = 0;
  std::int64_t number = 0;                 ///< Number of the picture for the client.
  int white = 255;                         ///< Pixel value of the sensor's full scale.
  std::shared_ptr<const Picture> picture;  ///< The picture, never null.
  CameraReading reading;                   ///< Measured axis positions of the camera at mid-exposure.
};

/// Returns the answer to the request `measure`: measurements of the arm in the picture, as layers with the
/// requested names (docs/viewer-protocol.md). The function corrects the perspective offset between the middle
/// of the tube's image and the image of the backbone. `choice` replaces region, colour and base; null: those
/// of the experiment are used.
[[nodiscard]] Node measure_answer(const ViewedRig& rig, const SeenPicture& seen,
                                  const std::vector<std::string>& layers,
                                  const SeeingChoice* choice = nullptr);
/// Returns the answer to the request `measure` for a picture file with this number, whose camera is unknown.
[[nodiscard]] Node measure_answer(const Photograph& photograph, std::int64_t number,
                                  const std::vector<std::string>& layers, const SeeingChoice* choice);

/// Returns the answer to the request `shape`: the arm's shape estimated from pictures of two or more cameras,
/// as poses of a second arm in the 3D view. `choices` replace region, colour and base for their cameras.
[[nodiscard]] Node shape_answer(const ViewedRig& rig, std::span<const SeenPicture> seen,
                                std::span<const CameraSeeingChoice> choices = {});

}  // namespace flexura
