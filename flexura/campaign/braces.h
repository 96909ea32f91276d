#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/node.h"

namespace flexura {

/// Returns the texts that a text with lists in braces stands for, the last list changing first:
/// "a.{0,1}.{x,y}" is a.0.x, a.0.y, a.1.x, a.1.y. A text without a complete list in braces is returned as it
/// is. Returns no texts if there were more than `most`.
[[nodiscard]] std::vector<std::string> expanded_braces(std::string_view text, std::size_t most);

/// Replaces each [[parameter]] of a campaign document whose `path` has lists in braces by one parameter per
/// path. Lists in `name` and `also` are expanded along with it. Throws InputError, with the position, if
/// the numbers of texts differ or are too large.
[[nodiscard]] Node with_expanded_parameters(Node document);

}  // namespace flexura
