#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Largest number of violations that are listed individually. The first and the worst violation of every
/// group are always listed.
inline constexpr std::size_t max_listed_violations = 500;

/// Returns the result of a check, as `flexura check --json` prints it: "safe", "violation_count", and the
/// lists "groups", "violations", "caveats" and "notes" (docs/safety.md). Sections are counted from 1, as in
/// texts.
[[nodiscard]] Node safety_node(const SafetyReport& report);

}  // namespace flexura
