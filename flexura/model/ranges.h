#pragma once

#include "flexura/base/field.h"

namespace flexura {

// Ranges used by several tables of this folder.
inline constexpr NumberRange coordinate_range = {.min = -1e6, .max = 1e6};  // m.
inline constexpr NumberRange share_range = {.min = 0, .max = 1};

}  // namespace flexura
