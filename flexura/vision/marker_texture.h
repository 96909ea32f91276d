#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "flexura/vision/arm_skin.h"

namespace flexura {

/// A texture of the arm's surface, such as a mesh or a bellows, seen along the arm.
struct SkinTexture {
  std::size_t count = 0;  ///< Number of stretches whose colour is not the arm's.
  double period = 0;      ///< Median distance between neighbouring stretches, px.
  double contrast = 0;    ///< Difference of colour that four fifths of the stretches do not exceed, of 255.
};

/// Returns the texture of an arm, if it has one: at least six stretches that differ from the arm's
/// colour by more than `bound`, whose distances are short for the arm's width.
[[nodiscard]] std::optional<SkinTexture> texture_of(const ArmSkin& skin, double thickness, double bound);

}  // namespace flexura
