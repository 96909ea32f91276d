#include "flexura/experiment/safety_nodes.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/log/messages.h"
#include "flexura/safety/violation_groups.h"

namespace flexura {
namespace {

Node section_node(std::size_t section) { return {static_cast<std::int64_t>(section) + 1, {}}; }

// Returns the key of a violation's name.
const char* name_key(Hazard hazard) {
  if (hazard == Hazard::obstacle) return "obstacle";
  const bool is_of_task =
      hazard == Hazard::workspace || hazard == Hazard::jump || hazard == Hazard::not_finite;
  return is_of_task ? "task" : "axis";
}

// `text` describes the violation, or all of its kind.
Node::Table violation_table(const Violation& violation, const std::string& text) {
  Node::Table table{{"hazard", {}, {std::string(name_of(violation.hazard)), {}}},
                    {"start", {}, {violation.start, {}}},
                    {"end", {}, {violation.end, {}}},
                    {"worst_time", {}, {violation.worst_time, {}}}};
  if (violation.section) table.push_back({"section", {}, section_node(*violation.section)});
  if (violation.other_section) table.push_back({"other_section", {}, section_node(*violation.other_section)});
  if (!violation.name.empty()) table.push_back({name_key(violation.hazard), {}, {violation.name, {}}});
  const bool has_value = violation.hazard != Hazard::not_finite && std::isfinite(violation.value);
  if (has_value) table.push_back({"value", {}, {violation.value, {}}});
  if (has_value && violation.hazard != Hazard::jump) table.push_back({"limit", {}, {violation.limit, {}}});
  if (violation.hazard == Hazard::jump)
    table.push_back({"of", {}, {std::string(violation.is_of_stretch ? "stretch" : "bend"), {}}});
  if (violation.target) table.push_back({"target", {}, point_node(*violation.target)});
  table.push_back({"text", {}, {text, {}}});
  return table;
}

// Returns its worst violation, with the times and the number of all.
Node group_node(const SafetyReport& report, const ViolationGroup& group) {
  Violation all = report.violations[group.worst];
  all.start = report.violations[group.members.front()].start;
  all.end = group.end;
  Node::Table table = violation_table(all, text_of(report, group));
  table.push_back({"count", {}, {static_cast<std::int64_t>(group.members.size()), {}}});
  return {std::move(table), {}};
}

}  // namespace

Node safety_node(const SafetyReport& report) {
  const std::vector<ViolationGroup> kept = most_relevant(report, grouped(report), max_violation_lines);
  Node::Array groups;
  for (const ViolationGroup& group : kept) groups.push_back(group_node(report, group));
  Node::Array violations;
  for (const std::size_t i : listed_violations(report, kept, max_listed_violations)) {
    const Violation& violation = report.violations[i];
    violations.push_back({violation_table(violation, violation.text()), {}});
  }
  return {Node::Table{{"safe", {}, {report.is_safe(), {}}},
                      {"violation_count", {}, {static_cast<std::int64_t>(report.violations.size()), {}}},
                      {"groups", {}, {std::move(groups), {}}},
                      {"violations", {}, {std::move(violations), {}}},
                      {"caveats", {}, texts_node(report.caveats)},
                      {"notes", {}, texts_node(report.notes)}},
          {}};
}

}  // namespace flexura
