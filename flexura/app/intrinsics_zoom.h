#pragma once

#include "flexura/app/intrinsics.h"
#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// `flexura intrinsics --zoom ...`: a lens at several positions of its zoom. As intrinsics_command.
[[nodiscard]] Node zoom_answer(const IntrinsicsArguments& arguments, const BoardTarget& board,
                               Progress& progress);

}  // namespace flexura
