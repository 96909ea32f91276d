#pragma once

#include <functional>

#include "flexura/model/arm.h"

namespace flexura {

/// Function that records the clock steps before the time `until`, s. `state_at` returns the arm's state at a
/// time since the task's start, s.
using RecordSteps = std::function<void(double until, const std::function<ArmState(double time)>& state_at)>;

}  // namespace flexura
