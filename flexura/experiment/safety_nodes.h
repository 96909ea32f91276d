#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// At most so many violations are listed one by one, though the first and the worst of every group are.
inline constexpr std::size_t max_listed_violations = 500;

/// What a check found, as `flexura check --json` prints it: "safe", "violation_count", and the lists
/// "groups", "violations", "caveats" and "notes" (docs/safety.md). Sections count from 1 as in texts.
[[nodiscard]] Node safety_node(const SafetyReport& report);

}  // namespace flexura
