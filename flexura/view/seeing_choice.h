#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/experiment/experiment.h"
#include "flexura/vision/arm_scene.h"

namespace flexura {

/// What a client says about the arm in the pictures of one camera (docs/vision.md, "Arms in front of
/// anything"). Coordinates are in px.
struct SeeingChoice {
  /// Corners of the region in which the arm is: two opposite ones of a rectangle, or at least three of a
  /// polygon; empty: the whole picture.
  std::vector<std::array<double, 2>> region = {};
  std::optional<std::array<double, 3>> color = {};  ///< Red, green and blue of the arm, from 0 to 255.
  std::optional<std::array<double, 2>> base = {};   ///< A pixel near the arm's base.
};

/// A choice, and the camera for which it is made.
struct CameraSeeingChoice : SeeingChoice {
  std::string camera = {};  ///< Name of the camera.
};

const Table<SeeingChoice>& fields_of(const SeeingChoice*);
const Table<CameraSeeingChoice>& fields_of(const CameraSeeingChoice*);

/// Returns `scene`, which may be null, with the region and the colour of `choice` instead of its own. Returns
/// null if nothing is left to separate the arm from its surroundings.
[[nodiscard]] std::shared_ptr<const ArmScene> chosen_scene(const std::shared_ptr<const ArmScene>& scene,
                                                           const SeeingChoice& choice);

/// Returns an experiment whose cameras have the regions and colours of `choices`; background pictures stay,
/// and the base is not used. Throws ViewRefusal for an unknown or repeated camera, and for a colour of a
/// camera with gray pictures.
[[nodiscard]] Experiment with_choices(Experiment experiment, std::span<const CameraSeeingChoice> choices);

/// Returns red, green and blue of the arm at a pixel: the median of each in the pixels at most two rows and
/// columns away. Throws ViewRefusal for a gray picture, and std::out_of_range for a pixel outside the
/// picture.
[[nodiscard]] std::array<int, 3> color_at(const Image<std::uint8_t>& picture, int u, int v);

/// Returns the answer to the request `color`. Throws as color_at().
[[nodiscard]] Node color_answer(const Image<std::uint8_t>& picture, std::int64_t number, int u, int v);

}  // namespace flexura
