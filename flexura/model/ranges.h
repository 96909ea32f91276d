#pragma once

#include "flexura/base/field.h"

namespace flexura {

// Ranges that several of this folder's tables ask for.
inline constexpr NumberRange coordinate_range = {.min = -1e6, .max = 1e6};  // m
inline constexpr NumberRange share_range = {.min = 0, .max = 1};

}  // namespace flexura
