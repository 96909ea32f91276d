#pragma once

#include <iosfwd>

#include "flexura/base/node.h"

namespace flexura {

/// Prints what `flexura intrinsics` answers as a table for people: the numbers of each camera, or of a lens
/// at each zoom, with standard deviations, the files written, and the notes.
void print_intrinsics(const Node& answer, std::ostream& out);

}  // namespace flexura
