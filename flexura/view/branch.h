#pragma once

#include "flexura/experiment/experiment.h"
#include "flexura/view/experiment_text.h"
#include "flexura/view/recording.h"

namespace flexura {

/// Returns the commanded arm state and the readings of the camera axes in the recording at `time`, s.
[[nodiscard]] RigInstant instant_at(const Recording& recording, double time);

/// Returns the recording's experiment with another start: the arm's command and the readings of the camera
/// axes are those of the recording at `time` (s). Differences between truth and model at the start stay
/// unchanged. Everything starts at rest. Throws ViewRefusal if the arm cannot start in that state.
[[nodiscard]] Experiment experiment_from(const Recording& recording, double time);

}  // namespace flexura
