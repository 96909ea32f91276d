#include "flexura/tasks/servo/servo_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/estimate/backbone_pixels.h"
#include "flexura/log/messages.h"
#include "flexura/model/backbone.h"
#include "flexura/report/image_picture.h"
#include "flexura/tasks/photograph.h"

namespace flexura {
namespace {

// Error of an exact shape: rounding, a polyline's corners.
constexpr double hardly = 1e-5;

Node error_node(const ServoError& error) {
  return {Node::Table{{"rms", {}, number_node(error.rms)},
                      {"most", {}, number_node(error.most)},
                      {"tip", {}, number_node(error.tip)}},
          {}};
}

Node numbers_node(const std::vector<double>& values) {
  Node::Array numbers;
  for (const double value : values) numbers.push_back(number_node(value));
  return {std::move(numbers), {}};
}

// Includes the last observation, command and request.
Node fault_node(const LimiterFault& fault, double start) {
  Node::Table members{{"time", {}, number_node(start + fault.time)}, {"reason", {}, {fault.reason, {}}}};
  const auto add = [&](const std::string& what, const ArmState& state) {
    members.push_back({what, {}, bends_node(state)});
    members.push_back({what + "_stretches", {}, numbers_node(state.stretches)});
  };
  if (fault.observed) add("observed", *fault.observed);
  add("sent", fault.sent);
  if (fault.asked) add("asked", *fault.asked);
  return {std::move(members), {}};
}

// Returns charts of the decreasing errors and the law's potential, as powers of ten over the time in the
// task.
std::array<ReportFigure, 2> falling_errors(const ServoRun& run, std::size_t number) {
  const auto power = [](double value, double least) { return std::log10(std::max(value, least)); };
  constexpr double least_share = 1e-7, least_potential = 1e-12;
  LineChart errors{.heading = "distance from the target shape",
                   .x_label = "time in the task (s)",
                   .value_label = "share of the length",
                   .series = {{"seen", {}}, {"tip", {}}, {"truth", {}}},
                   .is_log = true};
  LineChart potential{.heading = "half the square of the law's error",
                      .x_label = errors.x_label,
                      .value_label = "potential",
                      .series = {{"potential", {}}},
                      .is_log = true};
  for (const ServoStep& step : run.result.steps) {
    if (!step.is_fresh || !step.error) continue;
    errors.x.push_back(*step.seen_at - run.result.start);
    errors.series[0].values.push_back(power(step.error->rms, least_share));
    errors.series[1].values.push_back(power(step.error->tip, least_share));
    errors.series[2].values.push_back(step.truth ? power(step.truth->error.rms, least_share)
                                                 : std::numeric_limits<double>::quiet_NaN());
    potential.series[0].values.push_back(power(step.potential, least_potential));
  }
  potential.x = errors.x;
  return {ReportFigure{fmt::format("servo-{}-errors", number + 1), std::move(errors)},
          ReportFigure{fmt::format("servo-{}-potential", number + 1), std::move(potential)}};
}

// Returns a picture with the measured axis and the image of the target shape.
ReportFigure servo_photograph(const ServoRun& run, std::size_t i, bool is_last, std::size_t number) {
  const ServoObservation& observed = is_last ? *run.result.last : *run.result.first;
  const char* when = is_last ? "last" : "first";
  const auto found = std::ranges::find_if(
      run.nominal.cameras, [&](const CameraConfig& camera) { return camera.name == run.cameras[i]; });
  ImagePlot plot = photograph(*observed.frames[i].picture, found->sensor,
                              fmt::format("camera {}, {}", run.cameras[i], when));
  ImageOutline seen{"seen", "s2", {}}, desired{"target", "s1", {}};
  auto& axis = seen.lines.emplace_back();
  for (const CurvePoint& point : observed.seen[i].points) axis.points.push_back(point.pixel);
  constexpr int count = 60;
  desired.lines.emplace_back().points =
      backbone_pixels(run.nominal.arm, observed.desired, observed.seen[i].view, count);
  plot.outlines = {seen, desired};
  return {fmt::format("servo-{}-{}-{}", number + 1, run.cameras[i], when), image_picture(plot)};
}

std::string error_text(const ServoError& error) {
  return fmt::format("{:.3f} % of the length root mean square, {:.3f} % at most, {:.3f} % at the tip",
                     100 * error.rms, 100 * error.most, 100 * error.tip);
}

}  // namespace

TaskOutcome servo_outcome(const ServoRun& run) {
  const ServoResult& result = run.result;
  TaskOutcome outcome{.task = run.name,
                      .kind = "servo",
                      .noun = "servo",
                      .success = "converged",
                      .is_reached = result.is_done,
                      .text = {},
                      .size = {}};
  const double took = result.steps.empty() ? 0 : result.steps.back().time - result.start;
  outcome.text = result.is_done ? fmt::format("converged in {:.2f} s", took)
                                : fmt::format("not converged: {}", result.reason);
  if (result.remaining) {
    outcome.size = result.remaining->rms;
    outcome.size_text = fmt::format("{:.2g} % of the length rms", 100 * result.remaining->rms);
    outcome.text += ", " + outcome.size_text;
  }
  if (run.true_remaining) outcome.text += fmt::format(" (in truth {:.2g} %)", 100 * run.true_remaining->rms);
  return outcome;
}

Node servo_node(const ServoRun& run) {
  const ServoResult& result = run.result;
  Node::Table members{{"name", {}, {run.name, {}}},
                      {"done", {}, {result.is_done, {}}},
                      {"start", {}, number_node(result.start)},
                      {"steps", {}, {static_cast<std::int64_t>(result.steps.size()), {}}}};
  if (result.missed_steps > 0)
    members.push_back({"missed_steps", {}, {static_cast<std::int64_t>(result.missed_steps), {}}});
  if (!result.is_done) members.push_back({"reason", {}, {result.reason, {}}});
  if (result.settled) members.push_back({"settled", {}, number_node(*result.settled)});
  members.push_back({"overshoot", {}, number_node(result.overshoot)});
  if (result.missed > hardly) members.push_back({"target_missed", {}, number_node(result.missed)});
  if (result.remaining) members.push_back({"remaining", {}, error_node(*result.remaining)});
  if (result.sigma && std::isfinite(*result.sigma))
    members.push_back({"sigma", {}, number_node(*result.sigma)});
  if (run.true_remaining) members.push_back({"remaining_in_truth", {}, error_node(*run.true_remaining)});
  if (result.fault) members.push_back({"fault", {}, fault_node(*result.fault, result.start)});
  return {std::move(members), {}};
}

std::vector<ReportSpace::Target> servo_targets(const ServoRun& run, double duration) {
  constexpr std::size_t most = 100;
  std::vector<ReportSpace::Target> targets;
  const std::vector<ServoStep>& steps = run.result.steps;
  const std::size_t every = steps.size() / most + 1;
  for (std::size_t i = 0; i < steps.size(); i += every) {
    if (i > 0 && steps[i].desired == steps[i - every].desired) continue;
    const double start = i == 0 ? 0 : steps[i].time - run.result.start;
    if (!targets.empty()) targets.back().end = start;
    targets.push_back({.name = run.name,
                       .start = start,
                       .end = duration,
                       .shape = Backbone(run.nominal.arm, steps[i].desired)});
  }
  return targets;
}

Chapter servo_chapter(const ServoRun& run, std::size_t number) {
  const ServoResult& result = run.result;
  const double took = result.steps.empty() ? 0 : result.steps.back().time - result.start;
  Chapter chapter{"Servo: " + run.name,
                  result.is_done
                      ? fmt::format("The arm reached the target shape in {:.2f} s with {} commands.", took,
                                    result.steps.size())
                      : fmt::format("The arm did not reach the target shape: {}.", result.reason),
                  {},
                  {},
                  false};
  if (result.settled)
    chapter.points.push_back(
        fmt::format("The error stayed within 2 % of the arm's length after {:.2f} s. The tip overshot by "
                    "{:.1f} % of its path.",
                    *result.settled, 100 * std::max(0.0, result.overshoot)));
  if (result.remaining)
    chapter.points.push_back(fmt::format("Mean observed error over the last {:.3g} s: {}.", run.settle,
                                         error_text(*result.remaining)));
  if (result.sigma && std::isfinite(*result.sigma))
    chapter.points.push_back(
        fmt::format("Standard deviation of the last observed shape: {:.3f} % of the arm's length, root mean "
                    "square.",
                    100 * *result.sigma));
  if (run.true_remaining)
    chapter.points.push_back(fmt::format("Mean true error over the last {:.3g} s, from the simulation: {}.",
                                         run.settle, error_text(*run.true_remaining)));
  if (result.missed > hardly)
    chapter.points.push_back(
        fmt::format("The target is the nearest shape that the arm can take; it is {:.3f} % of the arm's "
                    "length from the requested shape.",
                    100 * result.missed));
  if (result.missed_steps > 0)
    chapter.points.push_back(
        fmt::format("{} control steps were skipped because the computation took longer than a step.",
                    result.missed_steps));
  for (std::size_t i = 0; i < 2; ++i) {
    if (result.first) chapter.figures.push_back(servo_photograph(run, i, false, number));
    if (result.last) chapter.figures.push_back(servo_photograph(run, i, true, number));
  }
  const bool has_errors =
      std::ranges::any_of(result.steps, [](const ServoStep& step) { return step.error && step.is_fresh; });
  if (has_errors)
    for (ReportFigure& figure : falling_errors(run, number)) chapter.figures.push_back(std::move(figure));
  return chapter;
}

}  // namespace flexura
