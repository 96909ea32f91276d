#pragma once

#include <cstdint>

#include "flexura/base/image.h"
#include "flexura/vision/arm_scene.h"

namespace flexura {

/// Separates the arm in part.box by the scene's background, colour and mask, and computes the share of the
/// arm in the light of each pixel near the arm's border (docs/vision.md, "Arms in front of anything"). Sets
/// part.figures, part.matte, part.soft, or part.reason if the scene does not fit the picture.
void make_matte(const ArmScene& scene, const Image<std::uint8_t>& picture, ScenePart& part);

}  // namespace flexura
