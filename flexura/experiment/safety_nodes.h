#pragma once

#include "flexura/base/node.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// What a check found, as `flexura check --json` prints it: "safe", and the lists "violations", "caveats" and
/// "notes" (docs/safety.md). Sections count from 1 as in texts.
[[nodiscard]] Node safety_node(const SafetyReport& report);

}  // namespace flexura
