#pragma once

#include "flexura/experiment/experiment.h"
#include "flexura/view/experiment_text.h"
#include "flexura/view/recording.h"

namespace flexura {

/// Returns the arm as commanded and the readings of the cameras in the recording at `time`, s.
[[nodiscard]] RigInstant instant_at(const Recording& recording, double time);

/// Returns the recording's experiment with another start: the arm is commanded as in the recording at `time`
/// (s), and the axes of the cameras read as they do then. The differences between truth and model at the
/// start stay. Everything starts at rest. Throws ViewRefusal if the arm cannot start there.
[[nodiscard]] Experiment experiment_from(const Recording& recording, double time);

}  // namespace flexura
