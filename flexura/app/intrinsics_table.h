#pragma once

#include <iosfwd>

#include "flexura/base/node.h"

namespace flexura {

/// Prints the answer of `flexura intrinsics` as a table. The table has the parameters of each camera, or of
/// the lens at each zoom, with standard deviations. Written files and notes follow.
void print_intrinsics(const Node& answer, std::ostream& out);

}  // namespace flexura
