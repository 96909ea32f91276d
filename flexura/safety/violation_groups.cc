#include "flexura/safety/violation_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "flexura/safety/spans.h"

namespace flexura {
namespace {

double excess(const Violation& violation) { return std::abs(violation.value - violation.limit); }

// Returns "3, 5 to 8" for section numbers from 0.
std::string ranges_text(const std::set<std::size_t>& sections) {
  std::string text;
  for (auto first = sections.begin(); first != sections.end();) {
    auto last = first;
    for (auto next = std::next(last); next != sections.end() && *next == *last + 1; ++next) last = next;
    if (!text.empty()) text += ", ";
    text += std::to_string(*first + 1);
    if (last != first) text += fmt::format(" to {}", *last + 1);
    first = std::next(last);
  }
  return text;
}

// Returns the sections that the group's section touches, if there are several.
std::string others_text(const SafetyReport& report, const ViolationGroup& group) {
  std::set<std::size_t> others;
  for (const std::size_t i : group.members) {
    const Violation& violation = report.violations[i];
    if (violation.other_section) others.insert(*violation.other_section);
  }
  return others.size() < 2 ? "" : ", with sections " + ranges_text(others);
}

}  // namespace

std::vector<ViolationGroup> grouped(const SafetyReport& report) {
  using Kind = std::tuple<Hazard, std::optional<std::size_t>, std::string, double, bool>;
  std::map<Kind, std::size_t> place_of;
  std::vector<ViolationGroup> groups;
  for (std::size_t i = 0; i < report.violations.size(); ++i) {
    const Violation& violation = report.violations[i];
    const Kind kind{violation.hazard, violation.section, violation.name, violation.limit,
                    violation.is_of_stretch};
    const auto [found, is_new] = place_of.try_emplace(kind, groups.size());
    if (is_new) groups.push_back({{}, i, violation.end});
    ViolationGroup& group = groups[found->second];
    group.members.push_back(i);
    group.end = std::max(group.end, violation.end);
    if (excess(violation) > excess(report.violations[group.worst])) group.worst = i;
  }
  return groups;
}

std::vector<ViolationGroup> most_relevant(const SafetyReport& report, std::vector<ViolationGroup> groups,
                                          std::size_t most) {
  if (groups.size() <= most) return groups;
  const auto worst = [&](std::size_t g) -> const Violation& { return report.violations[groups[g].worst]; };
  std::vector<std::size_t> order(groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t g) { return excess(worst(g)); });
  std::map<std::pair<Hazard, std::string>, std::size_t> ranked;
  std::vector<std::size_t> rank(groups.size());  // Rank among those of its hazard and obstacle.
  for (const std::size_t g : order)
    rank[g] = ranked[{worst(g).hazard, worst(g).hazard == Hazard::obstacle ? worst(g).name : ""}]++;
  std::ranges::stable_sort(order, {}, [&](std::size_t g) { return rank[g]; });
  order.resize(most);
  std::ranges::sort(order);
  std::vector<ViolationGroup> kept;
  kept.reserve(order.size());
  for (const std::size_t g : order) kept.push_back(std::move(groups[g]));
  return kept;
}

std::string text_of(const SafetyReport& report, const ViolationGroup& group) {
  const Violation& worst = report.violations[group.worst];
  if (group.members.size() == 1) return worst.text();
  const Span span{report.violations[group.members.front()].start, group.end};
  return fmt::format("{}, {} times{}; worst at {:.6g} s: {}", span_text(span), group.members.size(),
                     others_text(report, group), worst.worst_time, worst.what());
}

std::vector<std::string> violation_lines(const SafetyReport& report) {
  const std::vector<ViolationGroup> groups = grouped(report);
  std::vector<std::string> lines;
  lines.reserve(max_violation_lines + 1);
  for (const ViolationGroup& group : most_relevant(report, groups, max_violation_lines))
    lines.push_back(text_of(report, group));
  if (groups.size() > lines.size())
    lines.push_back(
        fmt::format("and {} more groups of less severe violations", groups.size() - lines.size()));
  return lines;
}

std::vector<std::size_t> listed_violations(const SafetyReport& report,
                                           const std::vector<ViolationGroup>& groups, std::size_t most) {
  std::set<std::size_t> listed;
  for (const ViolationGroup& group : groups) listed.insert({group.members.front(), group.worst});
  for (std::size_t i = 0; i < report.violations.size() && listed.size() < most; ++i) listed.insert(i);
  return {listed.begin(), listed.end()};
}

}  // namespace flexura
