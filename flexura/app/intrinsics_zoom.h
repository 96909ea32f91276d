#pragma once

#include <iosfwd>

#include "flexura/app/intrinsics.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// `flexura intrinsics --zoom ...`: a lens at several positions of its zoom. As intrinsics_command.
int zoom_command(const IntrinsicsArguments& arguments, const BoardTarget& board, std::ostream& out);

}  // namespace flexura
