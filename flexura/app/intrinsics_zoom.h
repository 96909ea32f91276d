#pragma once

#include <iosfwd>

#include "flexura/app/intrinsics.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// Runs `flexura intrinsics --zoom ...`, which calibrates a lens at several zoom positions. Return value and
/// errors as for intrinsics_command().
int zoom_command(const IntrinsicsArguments& arguments, const BoardTarget& board, std::ostream& out);

}  // namespace flexura
