#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flexura/vision/arm_scene.h"

namespace flexura {

/// Command-line arguments that tell the arm from its surroundings. Lists have no element, one for all
/// pictures, or one for each picture.
struct SceneArguments {
  /// Corners "U,V,U,V,..." of the region in which the arm is, px: two opposite corners of a rectangle, or at
  /// least three of a polygon.
  std::vector<std::string> regions = {};
  std::vector<std::string> backgrounds = {};  ///< Picture files without the arm.
  std::string color = {};                     ///< "R,G,B" of the arm, from 0 to 255; "": not given.
  std::vector<std::string> masks = {};        ///< Files of masks of the arm.
};

/// Reads the scene of each picture; `gammas` has the gamma of each. Pictures with equal scenes share one.
/// Returns null pointers if no argument is given. Throws InputError for wrong arguments and unreadable files.
[[nodiscard]] std::vector<std::shared_ptr<const ArmScene>> arm_scenes(const SceneArguments& arguments,
                                                                      std::span<const double> gammas);

}  // namespace flexura
