#include "flexura/tasks/motion/keyframes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/kinematics/shape.h"

namespace flexura {
namespace {

// Content of a column: a quantity of a section (from 0), and the factor to base units.
struct Column {
  std::string_view quantity;
  std::size_t section = 0;
  double factor = 1;
};

std::optional<Column> parse_column(std::string_view name) {
  constexpr std::string_view unit_separator = "_";
  if (name == "time" || name == "time_ms") return Column{"time", 0, name == "time" ? 1.0 : 1e-3};
  for (const std::string_view quantity : {"cord_angle", "arching", "bend_x", "bend_y", "stretch"}) {
    if (!name.starts_with(quantity) || !name.substr(quantity.size()).starts_with(unit_separator)) continue;
    std::string_view rest = name.substr(quantity.size() + 1);
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (error != std::errc{} || number == 0) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    for (const UnitSpelling& way : spellings(quantity == "stretch" ? Unit::none : Unit::radian)) {
      if (way.suffix == rest) return Column{quantity, number - 1, way.factor};
    }
  }
  return std::nullopt;
}

// For a column of angles.
const NumberRange& range_of(const Column& column) {
  if (column.quantity == "cord_angle") return angle_range;
  return column.quantity == "arching" ? arching_range : bend_range;
}

bool has(const std::vector<Column>& columns, std::string_view quantity, std::size_t section) {
  return std::ranges::any_of(columns,
                             [&](const Column& c) { return c.quantity == quantity && c.section == section; });
}

bool has_any(const std::vector<Column>& columns, std::string_view quantity) {
  return std::ranges::count(columns, quantity, &Column::quantity) > 0;
}

// Returns the quantities that define the bends, in one of up to three forms.
std::vector<std::vector<std::string_view>> ways_to_bend(ArmKind kind) {
  if (kind == ArmKind::spatial) return {{"bend_x", "bend_y"}};
  return {{"cord_angle"}, {"arching"}, {"bend_x"}};
}

void check_columns(const std::vector<std::string>& names, const std::vector<Column>& columns, ArmKind kind,
                   std::size_t sections, std::vector<KeyframeProblem>& problems) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column& column = columns[i];
    const auto same = [&](const Column& c) {
      return c.quantity == column.quantity && c.section == column.section;
    };
    if (std::ranges::count_if(columns, same) > 1) {
      problems.push_back({header_row, i, fmt::format("column {} occurs twice", names[i])});
    }
    if (column.section >= sections) {
      problems.push_back(
          {header_row, i, fmt::format("column {}: the arm has {} sections", names[i], sections)});
    }
    const bool is_planar_word = column.quantity == "cord_angle" || column.quantity == "arching";
    if (is_planar_word && kind == ArmKind::spatial) {
      problems.push_back(
          {header_row, i,
           fmt::format("column {} applies only to planar arms: expected bend_x_1, bend_y_1, ...", names[i])});
    }
    if (column.quantity == "bend_y" && kind == ArmKind::planar) {
      problems.push_back({header_row, i, fmt::format("column {} applies only to spatial arms", names[i])});
    }
  }
  if (!has_any(columns, "time")) problems.push_back({header_row, 0, "no column time"});
  const auto ways = ways_to_bend(kind);
  const auto used =
      std::ranges::count_if(ways, [&](const auto& way) { return has_any(columns, way.front()); });
  if (used > 1)
    problems.push_back(
        {header_row, 0, "gives the bends in more than one way: expected one of cord_angle, arching, bend_x"});
  for (const auto& way : ways) {
    if (used == 1 && !has_any(columns, way.front())) continue;
    for (const std::string_view quantity : way) {
      for (std::size_t section = 0; section < sections && used == 1; ++section) {
        if (!has(columns, quantity, section)) {
          problems.push_back({header_row, 0,
                              fmt::format("no column {}_{}: expected one column for each of {} sections",
                                          quantity, section + 1, sections)});
        }
      }
    }
  }
  if (used == 0)
    problems.push_back(
        {header_row, 0, "no columns for the bends: expected arching_1, cord_angle_1 or bend_x_1, ..."});
}

// `last`: time of the previous row, s.
std::string time_problem(double time, std::optional<double> last) {
  constexpr double longest = 1e6;
  if (!last) return time == 0 ? "" : fmt::format("time {}: expected 0 in the first row", time);
  if (time > longest) return fmt::format("time {} s: expected at most {} s", time, longest);
  if (!(time > *last)) return fmt::format("time {}: expected more than the previous time, {}", time, *last);
  // Smaller differences have no finite rates.
  constexpr double least_apart = 1e-9;
  return time - *last >= least_apart
             ? ""
             : fmt::format("time {}: expected at least {} s after the previous time, {}", time, least_apart,
                           *last);
}

void check_rows(const KeyframesTask& task, const std::vector<Column>& columns,
                std::vector<KeyframeProblem>& problems) {
  if (task.rows.size() < 2)
    problems.push_back(
        {all_rows, 0,
         fmt::format("{} row{}: expected at least 2", task.rows.size(), task.rows.size() == 1 ? "" : "s")});
  double last = 0;
  for (std::size_t r = 0; r < task.rows.size(); ++r) {
    const auto row = static_cast<std::ptrdiff_t>(r);
    if (task.rows[r].size() != columns.size()) {
      problems.push_back(
          {row, 0,
           fmt::format("{} values: expected {}, one per column", task.rows[r].size(), columns.size())});
      continue;
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double value = task.rows[r][c] * columns[c].factor;
      if (columns[c].quantity == "time") {
        const std::string problem = time_problem(value, r == 0 ? std::nullopt : std::optional(last));
        if (!problem.empty()) problems.push_back({row, c, problem});
        last = value;
      } else if (columns[c].quantity == "stretch") {
        const bool is_possible = value > 0 && value <= 100;
        if (!is_possible)
          problems.push_back({row, c, fmt::format("stretch {}: expected above 0 and at most 100", value)});
      } else if (const NumberRange& range = range_of(columns[c]); !range.contains(value)) {
        problems.push_back(
            {row, c,
             fmt::format("angle {} rad: expected {}", value, range.text(spellings(Unit::radian).front()))});
      }
    }
  }
}

std::vector<Column> columns_of(const std::vector<std::string>& names,
                               std::vector<KeyframeProblem>& problems) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const auto column = parse_column(names[i])) {
      columns.push_back(*column);
    } else {
      problems.push_back({header_row, i,
                          fmt::format("unknown column {}: expected time, arching_1, cord_angle_1, bend_x_1, "
                                      "bend_y_1 or stretch_1, ...",
                                      Node{names[i], {}}.brief())});
    }
  }
  return columns;
}

}  // namespace

std::vector<KeyframeProblem> keyframe_problems(const KeyframesTask& task, ArmKind kind,
                                               std::size_t sections) {
  std::vector<KeyframeProblem> problems;
  const std::vector<Column> columns = columns_of(task.columns, problems);
  if (problems.empty()) check_columns(task.columns, columns, kind, sections, problems);
  if (problems.empty()) check_rows(task, columns, problems);
  return problems;
}

MotionPtr keyframes_task_motion(const KeyframesTask& task, const Arm& arm) {
  std::vector<KeyframeProblem> none;
  const std::vector<Column> columns = columns_of(task.columns, none);
  const std::size_t sections = arm.sections.size();
  std::vector<double> times;
  std::vector<ArmState> states;
  for (const std::vector<double>& row : task.rows) {
    ShapeConfig shape;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto [quantity, section, factor] = columns[c];
      const double value = row[c] * factor;
      const auto put = [&](auto& values, auto initial) -> auto& {
        if (!values) values.emplace(sections, initial);
        return (*values)[section];
      };
      if (quantity == "time") times.push_back(value);
      if (quantity == "cord_angle") put(shape.cord_angles, 0.0) = value;
      if (quantity == "arching") put(shape.archings, 0.0) = value;
      if (quantity == "bend_x") put(shape.bends, std::array<double, 2>{})[0] = value;
      if (quantity == "bend_y") put(shape.bends, std::array<double, 2>{})[1] = value;
      if (quantity == "stretch") put(shape.stretches, 1.0) = value;
    }
    states.push_back(arm_state(arm, shape));
  }
  return keyframe_motion(std::move(times), states, task.interpolation);
}

}  // namespace flexura
