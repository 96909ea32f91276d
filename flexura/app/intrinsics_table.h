#pragma once

#include <iosfwd>

#include "flexura/base/node.h"

namespace flexura {

/// Prints the answer of `flexura intrinsics` as a table. The table has the parameters of each camera, or of
/// the lens at each zoom, with standard deviations. At the end are the written files and the notes.
void print_intrinsics(const Node& answer, std::ostream& out);

}  // namespace flexura
