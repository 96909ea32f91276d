#pragma once

#include "flexura/experiment/experiment.h"
#include "flexura/view/experiment_text.h"
#include "flexura/view/recording.h"

namespace flexura {

/// Returns the commanded arm state and the measured positions of the camera axes in the recording at `time`,
/// s.
[[nodiscard]] RigInstant instant_at(const Recording& recording, double time);

/// Returns the recording's experiment with a start in the state of the recording at `time` (s): the arm's
/// command and the measured positions of the camera axes. Initial differences between the true rig and its
/// model do not change. Everything starts at rest. Throws ViewRefusal if the arm cannot start in this state.
[[nodiscard]] Experiment experiment_from(const Recording& recording, double time);

}  // namespace flexura
