#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexura/experiment/player.h"
#include "flexura/experiment/run.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Returns what came of each task, in their order, then of the true arm (if its tip ends elsewhere than
/// commanded, and no task works by measurements) and of the recorded cameras. `true_tip_off`: distance of the
/// true tip from the commanded one at the end, m, if known. `frames`: of each camera that the log has.
[[nodiscard]] std::vector<TaskOutcome> run_outcomes(const Player& player, const Played& played,
                                                    std::optional<double> true_tip_off,
                                                    const std::map<std::string, std::int64_t>& frames);

/// Returns the whole run's outcome in one line: the total of its tasks, behind how the run ended if it is not
/// done. `time`: of its end, s.
[[nodiscard]] std::string headline_of(RunOutcome outcome, double time,
                                      const std::vector<TaskOutcome>& outcomes);

}  // namespace flexura
