#pragma once

#include <string>
#include <vector>

#include "flexura/app/intrinsics.h"
#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"

namespace flexura {

/// Returns notes on lengths that are probably not in metres: a board larger than 3 m, or a first camera that
/// is over 100 times as far from the origin as the boards are from it. Each note names the factor.
[[nodiscard]] std::vector<std::string> unit_notes(const IntrinsicsArguments& arguments,
                                                  const BoardTarget& board, const IntrinsicsFit& fit);

}  // namespace flexura
