#pragma once

#include <span>
#include <string>
#include <vector>

#include "flexura/app/estimate.h"
#include "flexura/app/estimate_config.h"
#include "flexura/camera/measured_camera.h"

namespace flexura {

/// Returns the shape in a file with the key `bends`, such as an answer of `flexura estimate`. Throws
/// InputError if the file is not readable or does not fit the arm.
[[nodiscard]] Shape read_guess(const std::string& file, const Arm& arm);

/// Fits the tube of the guessed shape to the pictures (TubeFitter). Otherwise like estimate_shape().
[[nodiscard]] ShapeAnswer estimate_near_guess(std::span<const PictureFile> pictures,
                                              const std::vector<MeasuredCamera>& cameras,
                                              const EstimateConfig& config, Progress* progress);

}  // namespace flexura
