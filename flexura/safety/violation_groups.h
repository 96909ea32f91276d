#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/safety/violation.h"

namespace flexura {

/// A group of violations with the same hazard, limit, section, motor or task, and obstacle. Self-contacts
/// with the same first section are in one group.
struct ViolationGroup {
  std::vector<std::size_t> members;  ///< Indices in SafetyReport::violations, ordered by time; at least one.
  std::size_t worst = 0;             ///< Index of the violation that exceeds its limit most.
  double end = 0;                    ///< Latest end of the group's violations, s.
};

/// Returns all violations in groups, ordered by the time of each group's first violation.
[[nodiscard]] std::vector<ViolationGroup> grouped(const SafetyReport& report);

/// Returns at most `most` of the groups, in the same order. The worst group of each hazard, and of each
/// obstacle, has priority.
[[nodiscard]] std::vector<ViolationGroup> most_relevant(const SafetyReport& report,
                                                        std::vector<ViolationGroup> groups, std::size_t most);

/// Returns the text of a group. For one violation: "0.5 s to 2 s: section 1: bend 62 deg, limit 60 deg". For
/// several violations: "0.5 s to 90 s, 90 times; worst at 1 s: section 1: bend 62 deg, limit 60 deg".
[[nodiscard]] std::string text_of(const SafetyReport& report, const ViolationGroup& group);

/// Largest number of lines for violations, not counting the line with the number of omitted violations.
inline constexpr std::size_t max_violation_lines = 100;

/// Returns the report's violations as lines of text, group by group.
[[nodiscard]] std::vector<std::string> violation_lines(const SafetyReport& report);

/// Returns the indices in SafetyReport::violations, ascending, of about `most` violations in `groups`. The
/// first and the worst violation of each group have priority, then others in the order of time.
[[nodiscard]] std::vector<std::size_t> listed_violations(const SafetyReport& report,
                                                         const std::vector<ViolationGroup>& groups,
                                                         std::size_t most);

}  // namespace flexura
