#include "flexura/safety/violation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/safety/spans.h"

namespace flexura {
namespace {

struct HazardText {
  const char* name;
  double factor;     // From base units to the units of texts.
  const char* unit;  // With a leading space.
};

const HazardText& text_of(Hazard hazard) {
  constexpr double degrees = 1 / degree;
  static constexpr std::array<HazardText, 14> texts{{{"bend", degrees, " deg"},
                                                     {"bend rate", degrees, " deg/s"},
                                                     {"stretch", 1, ""},
                                                     {"stretch rate", 1, " 1/s"},
                                                     {"folding: curvature times radius", 1, ""},
                                                     {"jump", degrees, " deg"},
                                                     {"no possible value", 1, ""},
                                                     {"self-contact", 1000, " mm deep"},
                                                     {"obstacle", 1000, " mm deep"},
                                                     {"motor speed", degrees, " deg/s"},
                                                     {"step rate", 1, " microsteps/s"},
                                                     {"motor acceleration", 1, " rad/s^2"},
                                                     {"motor position", 1, " microsteps"},
                                                     {"target outside the workspace", 1000, " mm"}}};
  return texts.at(static_cast<std::size_t>(hazard));
}

}  // namespace

const char* name_of(Hazard hazard) { return text_of(hazard).name; }

std::string amount_text(Hazard hazard, double amount) {
  const HazardText& shown = text_of(hazard);
  std::string_view unit = shown.unit;
  if (unit.ends_with(" deep")) unit.remove_suffix(5);
  return fmt::format("{:.3g}{}", amount * shown.factor, unit);
}

bool is_of_motor(Hazard hazard) {
  return hazard == Hazard::motor_speed || hazard == Hazard::step_rate ||
         hazard == Hazard::motor_acceleration || hazard == Hazard::motor_position;
}

std::string Violation::place() const {
  if (is_of_motor(hazard)) return fmt::format("axis {}: ", name);
  const bool is_of_task =
      hazard == Hazard::workspace || hazard == Hazard::jump || hazard == Hazard::not_finite;
  const std::string task = is_of_task && !name.empty() ? name + ": " : "";
  if (section && other_section && *section != *other_section)
    return fmt::format("sections {} and {}: ", *section + 1, *other_section + 1);
  return task + (section ? fmt::format("section {}: ", *section + 1) : "");
}

std::string Violation::finding() const {
  const HazardText& shown = text_of(hazard);
  const double found = value * shown.factor;
  switch (hazard) {
    case Hazard::obstacle:
      return fmt::format("contact with {}, {:.6g}{}", name, found, shown.unit);
    case Hazard::self_contact:
      return fmt::format("contact with {}, {:.6g}{}", section == other_section ? "itself" : "each other",
                         found, shown.unit);
    case Hazard::workspace:
      if (limit > 0)
        return fmt::format("{}, {:.6g}{} from the nearest shape, tolerance {:.6g}{}", shown.name, found,
                           shown.unit, limit * shown.factor, shown.unit);
      return fmt::format("{}, {:.6g}{} from the nearest pose", shown.name, found, shown.unit);
    case Hazard::not_finite:
      return shown.name;
    case Hazard::jump:
      if (is_of_stretch) return fmt::format("{} of {:.6g} in stretch", shown.name, value);
      return fmt::format("{} {:.6g}{}", shown.name, found, shown.unit);
    default:
      return fmt::format("{} {:.6g}{}, limit {:.6g}{}", shown.name, found, shown.unit, limit * shown.factor,
                         shown.unit);
  }
}

std::string Violation::what() const { return place() + finding(); }

std::string Violation::text() const { return span_text({start, end}) + ": " + what(); }

std::vector<std::size_t> most_relevant(const SafetyReport& report, std::size_t most) {
  const std::vector<Violation>& all = report.violations;
  const auto excess = [&](std::size_t i) { return std::abs(all[i].value - all[i].limit); };
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, excess);
  std::vector<int> rank(all.size());  // 0: worst of its hazard; 1: worst of another obstacle.
  std::set<Hazard> hazards;
  std::set<std::string> obstacles;
  for (const std::size_t i : order) {
    const bool is_new_obstacle = all[i].hazard == Hazard::obstacle && obstacles.insert(all[i].name).second;
    const bool is_new_hazard = hazards.insert(all[i].hazard).second;
    const int rank_of_more = is_new_obstacle ? 1 : 2;
    rank[i] = is_new_hazard ? 0 : rank_of_more;
  }
  const auto is_of_section = [&](std::size_t i) { return all[i].section && !is_of_motor(all[i].hazard); };
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::tuple(rank[i], !is_of_section(i), i); });
  std::vector<std::size_t> reported;
  for (const std::size_t i : order) {
    if (reported.size() >= most) break;
    const bool is_new = std::ranges::none_of(
        reported, [&](std::size_t other) { return all[other].worst_time == all[i].worst_time; });
    if (is_new) reported.push_back(i);
  }
  std::ranges::sort(reported);
  return reported;
}

void SafetyReport::sort() {
  std::ranges::sort(violations, {}, [](const Violation& v) {
    return std::tuple(v.start, v.section.value_or(0), v.hazard, v.name, v.end, v.other_section);
  });
}

}  // namespace flexura
