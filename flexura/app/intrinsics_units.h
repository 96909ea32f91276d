#pragma once

#include <string>
#include <vector>

#include "flexura/app/intrinsics.h"
#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"

namespace flexura {

/// Returns notes on lengths that are probably not in metres. Such a length is the size of a board above 3 m.
/// Another is a distance of the first camera from the origin above 100 times the distance of the boards from
/// the camera. Each note names the probable unit and its factor.
[[nodiscard]] std::vector<std::string> unit_notes(const IntrinsicsArguments& arguments,
                                                  const BoardTarget& board, const IntrinsicsFit& fit);

}  // namespace flexura
