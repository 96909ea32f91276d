#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "flexura/app/estimate_config.h"
#include "flexura/base/node.h"
#include "flexura/camera/measured_camera.h"

namespace flexura {

/// A picture's file.
struct PictureFile {
  std::string name;   ///< For messages.
  std::string bytes;  ///< Of whatever kind (docs/vision.md, "Kinds of pictures").
};

/// What the pictures show of the arm.
struct ShapeAnswer {
  Node answer;  ///< docs/estimation.md, "flexura estimate".
  bool is_found = false;
};

/// The shape in as many pictures as there are cameras, in their order. InputError: not a picture that can be
/// read.
[[nodiscard]] ShapeAnswer estimate_shape(std::span<const PictureFile> pictures,
                                         const std::vector<MeasuredCamera>& cameras,
                                         const EstimateConfig& config);

/// Prints the shape of the arm that the pictures show, as one JSON document (docs/estimation.md). Returns
/// exit_missed when no shape was found. InputError for bad input.
int estimate_command(const EstimateArguments& arguments, std::ostream& out);

}  // namespace flexura
