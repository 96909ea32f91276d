#pragma once

#include <functional>

#include "flexura/model/arm.h"

namespace flexura {

/// Records the clock steps before a time; `state_at` gives the arm's state at every time since the task's
/// start.
using RecordSteps = std::function<void(double until, const std::function<ArmState(double time)>& state_at)>;

}  // namespace flexura
