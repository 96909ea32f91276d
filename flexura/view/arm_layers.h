#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/camera/view.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/arm_scene.h"

namespace flexura {

/// An arm found in a picture.
struct FoundArm {
  Image<std::uint8_t> bytes;                   ///< The picture in 8 bits, in which markers are searched.
  std::shared_ptr<const ArmScene> scene = {};  ///< The scene with which the arm was searched; may be null.
  /// The camera that took the picture, if it is known.
  std::optional<View> view = {};
  ArmObservation arm = {};
};

/// Returns the names of all layers: "mask", "silhouette", "axis", "markers", "circle".
[[nodiscard]] std::span<const std::string_view> layer_names();

/// Returns the layers with the names `layers` for a picture (docs/viewer-protocol.md), and adds notes to
/// `notes`. With a known camera, the axis is the image of the backbone, otherwise the middle of the tube.
[[nodiscard]] Node::Array arm_layers(const FoundArm& found, const std::vector<std::string>& layers,
                                     std::vector<std::string>& notes);

}  // namespace flexura
