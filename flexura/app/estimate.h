#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "flexura/app/estimate_config.h"
#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/camera/measured_camera.h"

namespace flexura {

class TerminalProgress;

/// A picture file.
struct PictureFile {
  std::string name;   ///< Name of the file, for messages.
  std::string bytes;  ///< Contents of the file, in a format of docs/vision.md, "Kinds of pictures".
};

/// The shape estimated from the pictures.
struct ShapeAnswer {
  Node answer;  ///< The answer described in docs/estimation.md, "flexura estimate".
  bool is_found = false;
};

/// Estimates the arm's shape from one picture per camera, in the cameras' order. Throws InputError if a
/// picture cannot be read or does not have its camera's size. `progress`, if any, follows the work.
[[nodiscard]] ShapeAnswer estimate_shape(std::span<const PictureFile> pictures,
                                         const std::vector<MeasuredCamera>& cameras,
                                         const EstimateConfig& config, Progress* progress = nullptr);

/// Prints the estimated shape of the arm as one JSON document (docs/estimation.md). Returns exit_missed if no
/// shape was found. Throws InputError for bad input. `progress`, if any, follows the work.
int estimate_command(const EstimateArguments& arguments, std::ostream& out,
                     TerminalProgress* progress = nullptr);

}  // namespace flexura
