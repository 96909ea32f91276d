#pragma once

#include "flexura/app/intrinsics.h"
#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// Calibrates a lens at several zoom positions (`flexura intrinsics --zoom ...`). Throws the exceptions of
/// intrinsics_command().
[[nodiscard]] Node zoom_answer(const IntrinsicsArguments& arguments, const BoardTarget& board,
                               Progress& progress);

}  // namespace flexura
