#include "flexura/view/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/kinematics/shape.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/view/servo_extras.h"
#include "flexura/view/session.h"

namespace flexura {
namespace {

// Adds the names of one kind of quantity, with sections counted from 1.
void add_names(const char* stem, const char* unit, std::size_t count, std::vector<Quantity>& list) {
  for (std::size_t i = 1; i <= count; ++i) list.push_back({fmt::format("{}_{}", stem, i), unit});
}

bool can_stretch(const Arm& arm) {
  return std::ranges::any_of(
      arm.sections, [](const Section& section) { return section.stretch_limits != std::array{1.0, 1.0}; });
}

// Returns one state's values, in the order of the quantities.
std::vector<double> values_of(const ArmModel& model, const ArmState& state) {
  const Arm& arm = model.driven();
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
  const Eigen::Vector3d tip = model.backbone(state).tip().position;
  for (const double coordinate : tip) values.push_back(coordinate);
  return values;
}

// Appends a servo's errors at a time; an unreadable command counts as missing.
void append_servo(const Recording& recording, double time, std::vector<double>& values) {
  std::vector<std::optional<double>> errors(servo_quantities().size());
  try {
    if (const auto step = recording.servo_step(time)) errors = servo_values(*step);
  } catch (const InputError&) {
    errors.assign(errors.size(), std::nullopt);
  }
  for (const auto& error : errors) values.push_back(error.value_or(std::numeric_limits<double>::quiet_NaN()));
}

// Quantities of a rod.
struct ForceQuantities {
  explicit ForceQuantities(const Recording& recording)
      : tensions(recording.has_tensions() ? recording.rig()->actuators.size() : 0),
        has_energy(recording.has_energy()),
        has_contacts(recording.has_contacts()) {}

  [[nodiscard]] bool any() const { return tensions > 0 || has_energy || has_contacts; }
  void name(std::vector<Quantity>& list) const {
    if (has_energy)
      for (const char* part : {"kinetic", "elastic", "gravity", "total"})
        list.push_back({fmt::format("energy_{}", part), "J", "energy"});
    add_names("tension", "N", tensions, list);
    if (has_contacts) list.push_back({"contact_force", "N", {}});
  }
  void append(const Recording& recording, double time, std::vector<double>& values) const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const Recording::LoggedForces forces = recording.forces(time);
    if (has_energy) {
      const EnergyMessage at = forces.energy.value_or(EnergyMessage{time, none, none, none});
      values.insert(values.end(), {at.kinetic, at.strain, at.gravity, at.kinetic + at.strain + at.gravity});
    }
    for (std::size_t i = 0; i < tensions; ++i)
      values.push_back(i < forces.tensions.size() ? forces.tensions[i] : none);
    double sum = 0;
    for (const ContactMessage& each : forces.contacts)
      sum += Eigen::Vector3d(each.force.x, each.force.y, each.force.z).norm();
    if (has_contacts) values.push_back(sum);
  }

  std::size_t tensions;
  bool has_energy, has_contacts;
};

// Adds the indices in [first, last) of a curve's minimum and maximum, and of its borders of gaps.
void add_extremes(const std::vector<double>& curve, std::size_t first, std::size_t last,
                  std::vector<std::size_t>& kept) {
  std::optional<std::size_t> least, greatest;
  for (std::size_t i = first; i < last; ++i) {
    const bool is_gap = std::isnan(curve[i]);
    if (i > 0 && is_gap != std::isnan(curve[i - 1])) kept.insert(kept.end(), {i - 1, i});
    if (is_gap) continue;
    if (!least || curve[i] < curve[*least]) least = i;
    if (!greatest || curve[i] >= curve[*greatest]) greatest = i;
  }
  if (least) kept.insert(kept.end(), {*least, *greatest});
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
    for (const std::vector<double>& curve : curves) add_extremes(curve, first, last, kept);
  }
  std::ranges::sort(kept);
  kept.erase(std::ranges::unique(kept).begin(), kept.end());
  return kept;
}

std::vector<Quantity> SeriesTable::quantities(const Recording& recording) {
  const Arm& arm = recording.rig()->model.driven();
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
  ForceQuantities(recording).name(list);
  if (recording.has_servo()) std::ranges::copy(servo_quantities(), std::back_inserter(list));
  return list;
}

SeriesTable::SeriesTable(const Recording& recording) {
  const std::vector<Quantity> names = quantities(recording);
  std::vector<std::vector<double>*> curves;
  curves.reserve(names.size());
  for (const Quantity& quantity : names) curves.push_back(&curves_[quantity.name]);
  const ForceQuantities forces(recording);
  for (std::size_t place = 0; place < recording.states(); ++place) {
    times_.push_back(recording.time_of_state(place));
    std::vector<double> values = values_of(recording.rig()->model, recording.state(place));
    if (forces.any()) forces.append(recording, times_.back(), values);
    if (recording.has_servo()) append_servo(recording, times_.back(), values);
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
    for (const std::size_t place : kept) nodes.push_back(number_node(values[place]));
    return Node{std::move(nodes), {}};
  };
  Node::Table table{{"time", {}, list(times_)}};
  for (std::size_t i = 0; i < names.size(); ++i) table.push_back({names[i], {}, list(curves[i])});
  return {std::move(table), {}};
}

}  // namespace flexura
