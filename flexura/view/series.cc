#include "flexura/view/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "flexura/kinematics/shape.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/view/session.h"

namespace flexura {
namespace {

// The names of one kind of quantity, sections counted from 1.
void add_names(const char* stem, const char* unit, std::size_t count, std::vector<Quantity>& list) {
  for (std::size_t i = 1; i <= count; ++i) list.push_back({fmt::format("{}_{}", stem, i), unit});
}

bool can_stretch(const Arm& arm) {
  return std::ranges::any_of(
      arm.sections, [](const Section& section) { return section.stretch_limits != std::array{1.0, 1.0}; });
}

// One state's values, in the order of the quantities.
std::vector<double> values_of(const Arm& arm, const ArmState& state) {
  std::vector<double> values;
  const auto append = [&](const std::vector<double>& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  if (arm.kind == ArmKind::planar) {
    append(cord_angles(arm, state));
    append(archings(state));
  } else {
    for (const Eigen::Vector2d& bend : state.bends) values.push_back(bend.x());
    for (const Eigen::Vector2d& bend : state.bends) values.push_back(bend.y());
  }
  if (can_stretch(arm)) append(state.stretches);
  const Eigen::Vector3d tip = tip_pose(arm, state).position;
  for (const double coordinate : tip) values.push_back(coordinate);
  return values;
}

}  // namespace

std::vector<std::size_t> thinned(std::span<const std::vector<double>> curves, std::size_t points) {
  std::vector<std::size_t> kept;
  const std::size_t count = curves.empty() ? 0 : curves.front().size();
  if (count == 0) return kept;
  if (count <= points) {
    for (std::size_t i = 0; i < count; ++i) kept.push_back(i);
    return kept;
  }
  kept = {0, count - 1};
  const std::size_t stretches = points > 2 ? (points - 2) / (2 * curves.size()) : 0;
  for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
    const std::size_t first = count * stretch / stretches, last = count * (stretch + 1) / stretches;
    for (const std::vector<double>& curve : curves) {
      const auto [least, greatest] =
          std::ranges::minmax_element(curve.begin() + static_cast<std::ptrdiff_t>(first),
                                      curve.begin() + static_cast<std::ptrdiff_t>(last));
      kept.push_back(static_cast<std::size_t>(least - curve.begin()));
      kept.push_back(static_cast<std::size_t>(greatest - curve.begin()));
    }
  }
  std::ranges::sort(kept);
  kept.erase(std::ranges::unique(kept).begin(), kept.end());
  return kept;
}

std::vector<Quantity> SeriesTable::quantities(const Arm& arm) {
  std::vector<Quantity> list;
  const std::size_t sections = arm.sections.size();
  if (arm.kind == ArmKind::planar) {
    add_names("cord_angle", "rad", sections, list);
    add_names("arching", "rad", sections, list);
  } else {
    add_names("bend_x", "rad", sections, list);
    add_names("bend_y", "rad", sections, list);
  }
  if (can_stretch(arm)) add_names("stretch", "", sections, list);
  for (const char* axis : {"x", "y", "z"}) list.push_back({std::string("tip_") + axis, "m"});
  return list;
}

SeriesTable::SeriesTable(const Recording& recording) {
  const Arm& arm = recording.rig()->model;
  const std::vector<Quantity> names = quantities(arm);
  std::vector<std::vector<double>*> curves;
  curves.reserve(names.size());
  for (const Quantity& quantity : names) curves.push_back(&curves_[quantity.name]);
  for (std::size_t place = 0; place < recording.states(); ++place) {
    times_.push_back(recording.time_of_state(place));
    const std::vector<double> values = values_of(arm, recording.state(place));
    for (std::size_t i = 0; i < values.size(); ++i) curves[i]->push_back(values[i]);
  }
}

Node SeriesTable::answer(const std::vector<std::string>& names, std::size_t points) const {
  std::vector<std::vector<double>> curves;
  for (const std::string& name : names) {
    const auto found = curves_.find(name);
    if (found == curves_.end()) throw ViewRefusal("there is no quantity " + Node{name, {}}.brief());
    curves.push_back(found->second);
  }
  const std::vector<std::size_t> kept = thinned(curves, points);
  const auto list = [&](const std::vector<double>& values) {
    Node::Array nodes;
    for (const std::size_t place : kept) nodes.push_back({values[place], {}});
    return Node{std::move(nodes), {}};
  };
  Node::Table table{{"time", {}, list(times_)}};
  for (std::size_t i = 0; i < names.size(); ++i) table.push_back({names[i], {}, list(curves[i])});
  return {std::move(table), {}};
}

}  // namespace flexura
