#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/safety/violation.h"

namespace flexura {

/// Violations of one kind, which may come again and again: the same hazard and limit, of the same section,
/// motor or task, with the same obstacle. Of the arm touching itself, all pairs with the same first section.
struct ViolationGroup {
  std::vector<std::size_t> members;  ///< Places in SafetyReport::violations, by time; at least one.
  std::size_t worst = 0;             ///< The place of the one farthest from its limit.
  double end = 0;                    ///< Of the last that ends, s.
};

/// All violations in groups, by the time of their first one.
[[nodiscard]] std::vector<ViolationGroup> grouped(const SafetyReport& report);

/// At most `most` of the groups, in their order: the worst of every hazard (of every obstacle) before others.
[[nodiscard]] std::vector<ViolationGroup> most_telling(const SafetyReport& report,
                                                       std::vector<ViolationGroup> groups, std::size_t most);

/// "0.5 s to 2 s: section 1: bend 62 deg, limit 60 deg" of one violation; of more "0.5 s to 90 s, 90 times;
/// worst at 1 s: section 1: bend 62 deg, limit 60 deg".
[[nodiscard]] std::string text_of(const SafetyReport& report, const ViolationGroup& group);

/// Lines of text for what was found are no more than these, and one that says how many are left out.
inline constexpr std::size_t max_violation_lines = 100;

/// The report's violations, group by group, as lines of text.
[[nodiscard]] std::vector<std::string> violation_lines(const SafetyReport& report);

/// The first and the worst violation of every group in `groups`, and others in the order of time, `most` or
/// so: places in SafetyReport::violations, ascending.
[[nodiscard]] std::vector<std::size_t> listed_violations(const SafetyReport& report,
                                                         const std::vector<ViolationGroup>& groups,
                                                         std::size_t most);

}  // namespace flexura
