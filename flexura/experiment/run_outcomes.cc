#include "flexura/experiment/run_outcomes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

constexpr double same_instant = 1e-9;  // In s.

// Returns the outcome of one task. `is_whole`: every step was played.
TaskOutcome outcome_of(const TaskRunner& task, const Leg& leg, const Played& played, bool is_whole) {
  TaskOutcome outcome = task.outcome(*leg.motion);
  outcome.kind = leg.kind;
  if (is_whole || task.motion_source() != TaskMotionSource::known || leg.motion->duration() == 0)
    return outcome;
  const double played_of_it = played.time - leg.start;
  if (played_of_it <= same_instant)
    return not_begun(outcome.task, outcome.kind, outcome.noun, outcome.success);
  if (leg.end() <= played.time + same_instant) return outcome;
  outcome.is_reached = false, outcome.size.reset();
  outcome.text = fmt::format("stopped after {:.4g} s of {:.4g} s", played_of_it, leg.motion->duration());
  return outcome;
}

}  // namespace

std::vector<TaskOutcome> run_outcomes(const Player& player, const Played& played,
                                      std::optional<double> true_tip_off, const std::string& warning,
                                      const std::map<std::string, std::int64_t>& frames) {
  std::vector<TaskOutcome> outcomes;
  const Schedule& schedule = player.schedule();
  const bool is_whole = played.states > schedule.steps() && played.failure.empty();
  bool is_measured = false;
  for (std::size_t i = 0; i < player.tasks().size(); ++i) {
    outcomes.push_back(outcome_of(*player.tasks()[i], schedule.legs()[i], played, is_whole));
    is_measured = is_measured || player.tasks()[i]->motion_source() == TaskMotionSource::by_rig;
  }
  constexpr double shows = 1e-6;  // In m.
  if (true_tip_off && *true_tip_off > shows && !is_measured)
    outcomes.push_back(
        {.task = "true arm",
         .kind = "truth",
         .noun = "true arm",
         .success = "",
         .text = fmt::format("tip ends {} from its commanded position", length_text(*true_tip_off)),
         .size = {}});
  if (!warning.empty())
    outcomes.push_back(
        {.task = "true arm", .kind = "truth", .noun = "warning", .success = "", .text = warning, .size = {}});
  std::int64_t count = 0;
  for (const auto& [camera, of_camera] : frames) count += of_camera;
  if (count > 0)
    outcomes.push_back({.task = "recorded",
                        .kind = "record",
                        .noun = "recording",
                        .success = "",
                        .text = fmt::format("{} pictures of {} camera{}", count, frames.size(),
                                            frames.size() == 1 ? "" : "s"),
                        .size = {}});
  return outcomes;
}

std::string headline_of(RunOutcome outcome, double time, const std::vector<TaskOutcome>& outcomes) {
  std::string total = total_of(outcomes);
  switch (outcome) {
    case RunOutcome::done:
      break;
    case RunOutcome::unsafe:
      return "unsafe, only simulated: " + total;
    case RunOutcome::failed:
      return fmt::format("failed at {:.4g} s: {}", time, total);
    case RunOutcome::cancelled:
      return fmt::format("cancelled at {:.4g} s: {}", time, total);
  }
  return total;
}

}  // namespace flexura
