#include "flexura/tasks/dynamics/dynamics_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/base/node.h"

namespace flexura {
namespace {

double lyapunov_value(const DynamicsSample& sample) {
  return sample.energies.kinetic + sample.energies.potential;
}

// Shares and reasons are those of a law with exact angles.
Node verdict_node(const LyapunovVerdict& verdict, bool is_measured) {
  Node::Table members{{"monotone", {}, {verdict.is_monotone, {}}},
                      {"balanced", {}, {verdict.is_balanced, {}}},
                      {"settled", {}, {verdict.is_settled, {}}},
                      {"largest_rise", {}, number_node(verdict.largest_rise)},
                      {"imbalance", {}, number_node(verdict.imbalance)}};
  if (!is_measured) {
    members.push_back({"gravity_share", {}, number_node(verdict.gravity_share)});
    members.push_back({"elastic_share", {}, number_node(verdict.elastic_share)});
    members.push_back({"potential_share", {}, number_node(verdict.potential_share)});
    members.push_back({"reasons", {}, texts_node(verdict.reasons)});
  }
  return {std::move(members), {}};
}

// Returns at most as many samples as a picture can show, with the first and the last one.
std::vector<DynamicsSampleMessage> shown_samples(const DynamicsRun& run) {
  constexpr std::size_t most = 2000;
  const std::size_t every = run.samples.size() / most + 1;
  std::vector<DynamicsSampleMessage> shown;
  for (std::size_t i = 0; i + 1 < run.samples.size(); i += every)
    shown.push_back(run.message(run.samples[i]));
  shown.push_back(run.message(run.samples.back()));
  return shown;
}

using Value = std::function<double(const DynamicsSampleMessage&)>;

std::vector<ReportFigure> figures_of(const DynamicsRun& run, std::size_t number) {
  const std::vector<DynamicsSampleMessage> samples = shown_samples(run);
  std::vector<ReportFigure> figures;
  const auto draw = [&](const char* name, const char* heading, const char* label, double least,
                        const std::vector<std::pair<std::string, Value>>& lines) {
    LineChart chart{
        .heading = heading, .x_label = "time in the task (s)", .value_label = label, .least = least};
    for (const auto& [line, value] : lines) chart.series.push_back({line, {}});
    for (const DynamicsSampleMessage& sample : samples) {
      chart.x.push_back(sample.time - run.start);
      for (std::size_t i = 0; i < lines.size(); ++i)
        chart.series[i].values.push_back(lines[i].second(sample));
    }
    figures.push_back({fmt::format("dynamics-{}-{}", number + 1, name), std::move(chart)});
  };
  using Shown = DynamicsSampleMessage;
  constexpr double least_joule = 1e-9;
  std::vector<std::pair<std::string, Value>> lines = {
      {"W", &Shown::lyapunov}, {"T", &Shown::kinetic_energy}, {"Pi", &Shown::potential}};
  draw("lyapunov", "Lyapunov function W = T + Pi", "J", least_joule, lines);
  for (auto& [line, value] : lines)
    value = [=](const Shown& at) { return std::log10(std::max(value(at), least_joule)); };
  draw("lyapunov-powers", "change of W and removed energy", "J", 1, lines);
  std::get<LineChart>(figures.back().content).is_log = true;
  draw("energies", "the arm's energies, and the energy removed by damping", "J", least_joule,
       {{"gravity", &Shown::gravity_energy},
        {"elastic", &Shown::elastic_energy},
        {"law's damping", &Shown::taken_by_law},
        {"own damping", &Shown::taken_by_medium}});
  draw("errors", "errors of the angles, rms along the arm", "deg", 1e-3,
       {{"spatial", [](const Shown& at) { return at.spatial_error / degree; }},
        {"theta", [](const Shown& at) { return at.azimuth_error / degree; }},
        {"q", [](const Shown& at) { return at.elevation_error / degree; }}});
  return figures;
}

const char* yes_or_no(bool is_so) { return is_so ? "yes" : "no"; }

std::vector<std::string> findings_of(const DynamicsRun& run) {
  std::vector<std::string> points;
  points.reserve(run.violations.size());
  for (const std::string& violation : run.violations)
    points.push_back("A condition of the theory does not hold: " + violation + ".");
  if (!run.stopped.empty()) points.push_back("The task ended early: " + run.stopped + ".");
  if (run.verdict) {
    const LyapunovVerdict& verdict = *run.verdict;
    points.push_back(fmt::format(
        "W decreases monotonically: {} (largest rise {:.2g} J). The decrease of W equals the energy that "
        "damping removes: {} (largest difference {:.2g} J). W has settled at the end: {}.",
        yes_or_no(verdict.is_monotone), verdict.largest_rise, yes_or_no(verdict.is_balanced),
        verdict.imbalance, yes_or_no(verdict.is_settled)));
    if (run.is_measured) {
      points.emplace_back(
          "The law used measured angles with delay, noise or sampling. The theory assumes exact angles, so "
          "the measurement causes differences from the theory.");
    } else {
      for (const std::string& reason : verdict.reasons)
        points.push_back("Difference from the theory: " + reason + ".");
    }
  }
  if (run.triangulated > 0)
    points.push_back(
        fmt::format("{:.3g} % of all measured points of the arm were triangulated from both pictures. There, "
                    "a plane angle was within 10 deg of 90 deg, or 90 deg was between it and its target.",
                    100 * run.triangulated));
  constexpr double little = 1e-9;
  if (run.left_over > little)
    points.push_back(fmt::format("The drives could not produce up to {:.3g} % of the law's largest force.",
                                 100 * run.left_over));
  points.push_back(
      fmt::format("At the end, the error of theta is {:.3g} deg and the error of q is {:.3g} deg, root mean "
                  "square along the arm. The tip is {:.3g} mm from its target.",
                  run.remaining.azimuth / degree, run.remaining.elevation / degree, 1e3 * run.remaining.tip));
  const double off = std::max(run.plant.start_off(), run.plant.target_off());
  constexpr double shows = 1e-3;  // In rad.
  if (off > shows)
    points.push_back(
        fmt::format("The basis approximates the initial angles of the arm with an error of {:.3g} deg. The "
                    "error for the requested target is {:.3g} deg. Both are root mean squares along the arm.",
                    run.plant.start_off() / degree, run.plant.target_off() / degree));
  points.push_back(
      fmt::format("The arm is drawn as arcs that have its true directions at the sections' ends. The drawn "
                  "tip is at most {:.2g} mm from the true tip.",
                  1e3 * run.apart));
  return points;
}

}  // namespace

TaskOutcome dynamics_outcome(const DynamicsRun& run) {
  TaskOutcome outcome{.task = run.name,
                      .kind = "dynamics",
                      .noun = "law",
                      .success = "agree with the theory",
                      .is_reached = run.is_done(),
                      .text = {},
                      .size = run.remaining.tip,
                      .size_text = fmt::format("tip {} from its target", length_text(run.remaining.tip))};
  const char* course =
      run.is_measured ? "reached the target with measured angles" : "energy decreased as in theory";
  outcome.text = run.is_done() ? fmt::format("{}, {}", course, outcome.size_text)
                               : fmt::format("not as in theory: {}; {}", run.reason(), outcome.size_text);
  return outcome;
}

Node dynamics_node(const DynamicsRun& run) {
  const DynamicsSample& last = run.samples.back();
  Node::Table members{
      {"name", {}, {run.name, {}}},
      {"done", {}, {run.is_done(), {}}},
      {"reasons", {}, texts_node(run.reasons)},
      {"start", {}, number_node(run.start)},
      {"duration", {}, number_node(last.energies.time)},
      {"measured", {}, {run.is_measured, {}}},
      {"violations", {}, texts_node(run.violations)},
      {"lyapunov",
       {},
       {Node::Array{number_node(lyapunov_value(run.samples.front())), number_node(lyapunov_value(last))},
        {}}}};
  if (run.verdict) members.push_back({"verdict", {}, verdict_node(*run.verdict, run.is_measured)});
  members.push_back({"remaining",
                     {},
                     {Node::Table{{"azimuth", {}, number_node(run.remaining.azimuth)},
                                  {"elevation", {}, number_node(run.remaining.elevation)},
                                  {"spatial", {}, number_node(run.remaining.spatial)},
                                  {"tip", {}, number_node(run.remaining.tip)}},
                      {}}});
  members.push_back({"start_off", {}, number_node(run.plant.start_off())});
  members.push_back({"target_off", {}, number_node(run.plant.target_off())});
  members.push_back({"left_over", {}, number_node(run.left_over)});
  if (run.is_measured) members.push_back({"triangulated", {}, number_node(run.triangulated)});
  members.push_back({"arcs_apart", {}, number_node(run.apart)});
  return {std::move(members), {}};
}

Chapter dynamics_chapter(const DynamicsRun& run, std::size_t number) {
  const double from = lyapunov_value(run.samples.front()), to = lyapunov_value(run.samples.back());
  const std::string course =
      fmt::format("The Lyapunov function W changed from {:.3g} J to {:.3g} J in {:.4g} s.", from, to,
                  run.samples.back().energies.time);
  std::string text = fmt::format("Not in agreement with the theory: {}. {}", run.reason(), course);
  if (run.is_done())
    text = run.is_measured ? "The arm reached the target with measured angles. " + course
                           : "The arm reached the target in agreement with the theory: W decreased "
                             "monotonically. The decrease of W equals the energy that damping removed. " +
                                 course;
  Chapter chapter{"Dynamics: " + run.name, std::move(text), {}, findings_of(run), false};
  if (run.samples.size() > 1) chapter.figures = figures_of(run, number);
  return chapter;
}

}  // namespace flexura
