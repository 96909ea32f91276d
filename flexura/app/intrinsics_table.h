#pragma once

#include <iosfwd>

#include "flexura/base/node.h"

namespace flexura {

/// Prints the answer of `flexura intrinsics` as a table. It has the parameters of each camera, or of a lens
/// at each zoom, with standard deviations, and the written files and notes.
void print_intrinsics(const Node& answer, std::ostream& out);

}  // namespace flexura
