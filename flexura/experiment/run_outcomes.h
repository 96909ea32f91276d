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

/// Returns the results of the tasks in their order, then those of the true arm and of the recorded cameras.
/// The true arm is included in two cases: its tip does not end where commanded and no task uses measurements;
/// or its simulation is not valid. `true_tip_off`: final distance of the true tip from the commanded tip, m,
/// if known. `warning`: first warning about the simulation of the true arm, or "". `frames`: number of frames
/// of each camera in the log.
[[nodiscard]] std::vector<TaskOutcome> run_outcomes(const Player& player, const Played& played,
                                                    std::optional<double> true_tip_off,
                                                    const std::string& warning,
                                                    const std::map<std::string, std::int64_t>& frames);

/// Returns the run's result in one line: a summary of its tasks' results. For an outcome other than `done`,
/// the line begins with the outcome. `time`: time of the end, s.
[[nodiscard]] std::string headline_of(RunOutcome outcome, double time,
                                      const std::vector<TaskOutcome>& outcomes);

}  // namespace flexura
