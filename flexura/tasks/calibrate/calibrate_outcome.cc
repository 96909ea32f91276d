#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/calibrate/calibrate_table.h"

namespace flexura {
namespace {

// Returns "89.990" for an angle of that many degrees.
std::string degrees_between_axes(double angle_from_square) {
  return fmt::format("{:.3f}", 90 + angle_from_square / degree);
}

// A standard deviation and what was required of it.
struct Accuracy {
  std::string name, unit;
  double is = 0, required = 0;  // In this unit.
  [[nodiscard]] bool is_reached() const { return is <= required; }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} +- {:.2g}{} (required {:.2g})", name, is, unit, required);
  }
};

TaskOutcome outcome_of_bundle(const CalibrationRun& run, TaskOutcome outcome) {
  const RigSigmas& is = run.result.steps.back().sigmas;
  const RigSigmas& required = run.required;
  const std::string axes = "axes " + degrees_between_axes(run.result.remainder.angle);
  const Accuracy angle = {axes, " degrees", is.angle / degree, required.angle / degree};
  std::vector<Accuracy> others;
  others.reserve(3);
  for (std::size_t i = 0; i < 2; ++i)
    others.push_back({"focal length of " + run.cameras[i], " %", 100 * is.focal[i], 100 * required.focal[i]});
  others.push_back({"zoom ratio", " %", 100 * is.zoom_ratio, 100 * required.zoom_ratio});
  std::erase_if(others, &Accuracy::is_reached);
  outcome.is_reached = angle.is_reached() && others.empty();
  outcome.text = angle.text();
  for (const Accuracy& other : others) outcome.text += ", " + other.text();
  outcome.text += outcome.is_reached ? ": reached" : ": not reached";
  outcome.brief = angle.text() + (outcome.is_reached ? ": reached" : ": not reached");
  if (run.truth) outcome.text += fmt::format("; true value: {}", degrees_between_axes(run.truth->angle));
  outcome.size = is.angle / required.angle;
  outcome.size_text = angle.text();
  return outcome;
}

TaskOutcome outcome_of_loop(const CalibrationRun& run, TaskOutcome outcome) {
  const LoopResult& loop = *run.loop;
  const std::vector<LoopOffset> offsets = loop_offsets(run);
  const auto missed = std::ranges::find_if_not(offsets, &LoopOffset::is_reached);
  outcome.is_reached = missed == offsets.end();
  outcome.text = fmt::format("offsets within {:.3g} px after {} pictures: ", run.accepted,
                             loop.pictures[0] + loop.pictures[1]);
  outcome.text += outcome.is_reached ? "reached"
                                     : fmt::format("not reached: the offset of {} is {:.3g}",
                                                   missed->quantity, std::abs(missed->last->offset));
  if (loop.angle)
    outcome.text +=
        fmt::format("; observed angle between the axes: {} degrees", degrees_between_axes(*loop.angle));
  if (run.truth)
    outcome.text += fmt::format("; true angle: {} degrees", degrees_between_axes(run.truth->angle));
  return outcome;
}

}  // namespace

TaskOutcome calibration_outcome(const CalibrationRun& run) {
  TaskOutcome outcome{.task = run.name,
                      .kind = "calibrate",
                      .noun = "calibration",
                      .success = "reached",
                      .is_reached = run.is_done(),
                      .text = "not calibrated: " + run.reason(),
                      .size = {}};
  if (!run.is_done()) return outcome;
  return run.loop ? outcome_of_loop(run, std::move(outcome)) : outcome_of_bundle(run, std::move(outcome));
}

}  // namespace flexura
