#pragma once

#include "flexura/base/field.h"

namespace flexura {

// Ranges of lens parameters in files.
inline constexpr NumberRange focal_length_range = {.min = 1e-3, .max = 1e7};     ///< px
inline constexpr NumberRange principal_point_range = {.min = -1e7, .max = 1e7};  ///< px
/// Range of each distortion coefficient. Calibrations of long lenses give coefficients of some ten thousand.
inline constexpr NumberRange distortion_range = {.min = -1e9, .max = 1e9};

}  // namespace flexura
