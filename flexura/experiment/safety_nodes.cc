#include "flexura/experiment/safety_nodes.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace flexura {
namespace {

Node section_node(std::size_t section) { return {static_cast<std::int64_t>(section) + 1, {}}; }

// What a violation's name is the name of.
const char* name_key(Hazard hazard) {
  if (hazard == Hazard::obstacle) return "obstacle";
  const bool is_of_task =
      hazard == Hazard::workspace || hazard == Hazard::jump || hazard == Hazard::not_finite;
  return is_of_task ? "task" : "axis";
}

Node violation_node(const Violation& violation) {
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
  table.push_back({"text", {}, {violation.text(), {}}});
  return {std::move(table), {}};
}

Node lines_node(const std::vector<std::string>& lines) {
  Node::Array nodes;
  for (const std::string& line : lines) nodes.push_back({line, {}});
  return {std::move(nodes), {}};
}

}  // namespace

Node safety_node(const SafetyReport& report) {
  Node::Array violations;
  for (const Violation& violation : report.violations) violations.push_back(violation_node(violation));
  return {Node::Table{{"safe", {}, {report.is_safe(), {}}},
                      {"violations", {}, {std::move(violations), {}}},
                      {"caveats", {}, lines_node(report.caveats)},
                      {"notes", {}, lines_node(report.notes)}},
          {}};
}

}  // namespace flexura
