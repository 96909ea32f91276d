#pragma once

#include <string>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {

/// The problems of one line of input, in one line; the place is the line itself, which the asker knows.
[[nodiscard]] std::string joined(const std::vector<Problem>& problems);

}  // namespace flexura
