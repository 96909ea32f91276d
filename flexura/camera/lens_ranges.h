#pragma once

#include "flexura/base/field.h"

namespace flexura {

// Ranges of lens parameters in files.
inline constexpr NumberRange focal_length_range = {.min = 1e-3, .max = 1e7};  ///< Range of focal lengths, px.
/// Range of the principal point's coordinates, px.
inline constexpr NumberRange principal_point_range = {.min = -1e7, .max = 1e7};
/// Range of each distortion coefficient. Calibrations of lenses with long focal lengths can yield
/// coefficients above 10,000.
inline constexpr NumberRange distortion_range = {.min = -1e9, .max = 1e9};

}  // namespace flexura
