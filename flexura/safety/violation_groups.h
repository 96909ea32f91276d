#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/safety/violation.h"

namespace flexura {

/// A group of violations with equal hazard, limit, section, motor or task, and obstacle. Self-contacts with
/// equal first sections are in one group.
struct ViolationGroup {
  /// Indices of at least one violation in SafetyReport::violations, ordered by time.
  std::vector<std::size_t> members;
  std::size_t worst = 0;  ///< Index of the violation that exceeds its limit most.
  double end = 0;         ///< Latest end of the group's violations, s.
};

/// Returns all violations in groups. Groups are ordered by the time of their first violation.
[[nodiscard]] std::vector<ViolationGroup> grouped(const SafetyReport& report);

/// Returns at most `most` of the groups, in their order. The worst group of each hazard, and of each
/// obstacle, has priority.
[[nodiscard]] std::vector<ViolationGroup> most_relevant(const SafetyReport& report,
                                                        std::vector<ViolationGroup> groups, std::size_t most);

/// Returns the text of a group. For one violation: "0.5 s to 2 s: section 1: bend 62 deg, limit 60 deg". For
/// several violations: "0.5 s to 90 s, 90 times; worst at 1 s: section 1: bend 62 deg, limit 60 deg".
[[nodiscard]] std::string text_of(const SafetyReport& report, const ViolationGroup& group);

/// Largest number of lines for violations. The line with the number of omitted groups is not counted.
inline constexpr std::size_t max_violation_lines = 100;

/// Returns the report's violations as lines of text, group by group.
[[nodiscard]] std::vector<std::string> violation_lines(const SafetyReport& report);

/// Selects about `most` violations in `groups` and returns their ascending indices in
/// SafetyReport::violations. The first and the worst violation of each group have priority, then others in
/// the order of time.
[[nodiscard]] std::vector<std::size_t> listed_violations(const SafetyReport& report,
                                                         const std::vector<ViolationGroup>& groups,
                                                         std::size_t most);

}  // namespace flexura
