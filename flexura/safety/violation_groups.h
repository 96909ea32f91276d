#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/safety/violation.h"

namespace flexura {

/// Violations of one kind, which may repeat: equal hazard and limit, section, motor or task, and obstacle.
/// For self-contacts, all pairs with the same first section.
struct ViolationGroup {
  std::vector<std::size_t> members;  ///< Indices in SafetyReport::violations, by time; at least one.
  std::size_t worst = 0;             ///< Index of the one farthest from its limit.
  double end = 0;                    ///< Latest end of its violations, s.
};

/// Returns all violations in groups, by the time of their first one.
[[nodiscard]] std::vector<ViolationGroup> grouped(const SafetyReport& report);

/// Returns at most `most` of the groups, in their order: the worst of every hazard (of every obstacle) before
/// others.
[[nodiscard]] std::vector<ViolationGroup> most_relevant(const SafetyReport& report,
                                                        std::vector<ViolationGroup> groups, std::size_t most);

/// Returns "0.5 s to 2 s: section 1: bend 62 deg, limit 60 deg" for one violation. For several it is "0.5 s
/// to 90 s, 90 times; worst at 1 s: section 1: bend 62 deg, limit 60 deg".
[[nodiscard]] std::string text_of(const SafetyReport& report, const ViolationGroup& group);

/// Most lines of text for violations, without the line with the number of omitted ones.
inline constexpr std::size_t max_violation_lines = 100;

/// Returns the report's violations, group by group, as lines of text.
[[nodiscard]] std::vector<std::string> violation_lines(const SafetyReport& report);

/// Returns the first and the worst violation of every group in `groups`, and others in the order of time,
/// about `most`. The result has indices in SafetyReport::violations, ascending.
[[nodiscard]] std::vector<std::size_t> listed_violations(const SafetyReport& report,
                                                         const std::vector<ViolationGroup>& groups,
                                                         std::size_t most);

}  // namespace flexura
