#include "flexura/experiment/report_safety.h"

#include <algorithm>
#include <utility>

#include "flexura/safety/motion_check.h"
#include "flexura/safety/violation_groups.h"

namespace flexura {
namespace {

ReportData::Safety shown_safety(const SafetyReport& safety) {
  ReportData::Safety shown;
  for (const Violation& violation : safety.violations) {
    auto& reported = shown.violations.emplace_back();
    reported.start = violation.start, reported.end = violation.end, reported.text = violation.text();
    reported.target = violation.target;
    for (const auto& section : {violation.section, violation.other_section})
      if (section) reported.sections.push_back(*section);
  }
  for (const ViolationGroup& group : grouped(safety))
    shown.lines.push_back({safety.violations[group.members.front()].start, text_of(safety, group)});
  shown.remarks = safety.caveats;
  shown.remarks.insert(shown.remarks.end(), safety.notes.begin(), safety.notes.end());
  return shown;
}

}  // namespace

void add_state(double time, const Schedule& schedule, ReportData& data) {
  const auto next = std::ranges::lower_bound(data.times, time);
  constexpr double same = 1e-9;  // In s: smaller differences are irrelevant.
  const bool is_there = next != data.times.begin() && time - *(next - 1) <= same;
  if (is_there || next == data.times.end() || *next - time <= same) return;
  ArmState state = schedule.state_at(time);
  if (!is_possible(state)) return;
  data.states.insert(data.states.begin() + (next - data.times.begin()), std::move(state));
  data.times.insert(next, time);
}

void add_safety(const SafetyReport& safety, const Schedule& schedule, ReportData& data) {
  data.safety = shown_safety(safety);
  SafetyReport worst;  // One of each group: repeated violations look alike.
  for (const ViolationGroup& group : grouped(safety))
    worst.violations.push_back(safety.violations[group.worst]);
  for (const std::size_t i : most_relevant(worst, max_pictured_violations)) {
    const double when = worst.violations[i].worst_time;
    // Other violations with their worst value at that time are in the same picture.
    for (std::size_t k = 0; k < safety.violations.size(); ++k) {
      if (safety.violations[k].worst_time == when) data.safety->violations[k].pictured_at = when;
    }
    add_state(when, schedule, data);
  }
}

}  // namespace flexura
