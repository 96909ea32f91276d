#include "flexura/report/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/model/arm_model.h"
#include "flexura/report/arm_curve.h"
#include "flexura/report/svg.h"

namespace flexura {
namespace {

// More events would hide the charts.
constexpr std::size_t max_event_times = 40;

std::size_t nearest_index(const std::vector<double>& times, double time) {
  const auto next = std::ranges::lower_bound(times, time);
  if (next == times.begin()) return 0;
  if (next == times.end()) return times.size() - 1;
  const auto index = static_cast<std::size_t>(next - times.begin());
  return time - times[index - 1] <= times[index] - time ? index - 1 : index;
}

void keep_each_once(std::vector<std::size_t>& indices) {
  std::ranges::sort(indices);
  const auto repeated = std::ranges::unique(indices);
  indices.erase(repeated.begin(), repeated.end());
}

// Returns `most` (>= 2) of the numbers 0 to count - 1, evenly spaced, with the first and the last.
std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  std::vector<std::size_t> indices;
  const std::size_t steps = std::min(count, most) - 1;
  for (std::size_t i = 0; i <= steps; ++i) indices.push_back(steps == 0 ? 0 : i * (count - 1) / steps);
  return indices;
}

void require_usable(const ReportData& data) {
  if (data.times.empty() || data.times.size() != data.states.size()) {
    throw std::invalid_argument(fmt::format(
        "a report needs at least one state and one time per state: there are {} times and {} states",
        data.times.size(), data.states.size()));
  }
  for (std::size_t i = 0; i < data.times.size(); ++i) {
    if (!std::isfinite(data.times[i]) || (i > 0 && data.times[i] < data.times[i - 1])) {
      throw std::invalid_argument(
          fmt::format("time {} of a report is {}: expected increasing times", i, data.times[i]));
    }
  }
}

// Returns the times of violations with separate pictures.
std::vector<double> pictured_times(const ReportMotion& motion) {
  std::vector<double> times;
  for (const auto& violation : motion.violations) {
    if (violation.pictured_at) times.push_back(*violation.pictured_at);
  }
  return times;
}

std::vector<double> event_times(const ReportData& data) {
  std::vector<double> times;
  for (const ReportData::Mark& event : data.events) {
    if (event.time >= data.times.front() && event.time <= data.times.back()) times.push_back(event.time);
  }
  std::ranges::sort(times);
  const auto repeated = std::ranges::unique(times);
  times.erase(repeated.begin(), repeated.end());
  return times;
}

// In the order of the violations.
std::vector<UnsafeMoment> unsafe_moments(const ReportMotion& motion) {
  std::vector<UnsafeMoment> moments;
  for (std::size_t i = 0; i < motion.violations.size(); ++i) {
    const auto& when = motion.violations[i].pictured_at;
    if (!when) continue;
    const std::size_t state = nearest_index(motion.times, *when);
    auto moment = std::ranges::find(moments, state, &UnsafeMoment::state);
    if (moment == moments.end()) moment = moments.insert(moments.end(), {{}, state});
    moment->violations.push_back(i);
  }
  return moments;
}

// Returns true if nobody sees a difference.
bool is_same(const ArmState& a, const ArmState& b) {
  constexpr double invisible = 1e-12;
  for (std::size_t i = 0; i < a.bends.size(); ++i)
    if ((a.bends[i] - b.bends[i]).norm() > invisible || std::abs(a.stretches[i] - b.stretches[i]) > invisible)
      return false;
  return true;
}

}  // namespace

std::vector<std::size_t> kept_indices(const std::vector<double>& times, const std::vector<double>& desired,
                                      std::size_t most) {
  if (times.size() <= most) return evenly(times.size(), times.size());
  // Keeps the first and the last, and at most half of all for the requested times.
  const std::size_t marks = std::min(desired.size(), most / 2 - 1);
  std::vector<std::size_t> kept = evenly(times.size(), most - marks);
  for (std::size_t i = 0; i < marks; ++i)
    kept.push_back(nearest_index(times, desired[i * desired.size() / marks]));
  keep_each_once(kept);
  return kept;
}

bool ReportMotion::is_unsafe(std::size_t section, std::size_t i) const {
  return std::ranges::any_of(violations, [&](const auto& violation) {
    return violation.start <= times[i] && times[i] <= violation.end &&
           std::ranges::count(violation.sections, section) > 0;
  });
}

int ReportMotion::tip_coordinates() const {
  return in_plane && std::abs(arm.X_WB.position.z()) < 1e-9 * arm.length() ? 2 : 3;
}

std::string ReportMotion::tip_text(std::size_t i) const {
  std::string text = "E(";
  for (int axis = 0; axis < tip_coordinates(); ++axis)
    text += (axis == 0 ? "" : ", ") + fixed(tip(i)[axis], 3);
  return text + ')';
}

ReportMotion motion_of(const ReportData& data) {
  require_usable(data);
  const ArmModel model = data.model.value_or(ArmModel(data.arm));
  ReportMotion motion;
  motion.arm = data.arm;
  motion.model = model;
  if (data.safety) motion.violations = data.safety->violations;
  motion.obstacles = data.obstacles;
  motion.curve = data.curve;
  motion.tension = data.tension;
  motion.in_plane = lies_in_xoy(data.arm);
  motion.recorded = std::max(data.recorded, data.states.size());
  const std::vector<double> marks = event_times(data);
  if (marks.size() <= max_event_times) motion.event_times = marks;

  const std::size_t numbers = 3 * std::max<std::size_t>(data.arm.sections.size(), 1);
  const std::size_t most = std::clamp<std::size_t>(max_shown_numbers / numbers, 2, max_shown_states);
  std::vector<std::size_t> kept = kept_indices(data.times, marks, most);
  for (const double time : pictured_times(motion)) kept.push_back(nearest_index(data.times, time));
  kept.push_back(nearest_index(data.times, (data.times.front() + data.times.back()) / 2));
  keep_each_once(kept);
  for (const std::size_t i : kept) {
    motion.times.push_back(data.times[i]);
    motion.states.push_back(data.states[i]);
    motion.backbones.push_back(model.backbone(data.states[i]));
    for (const double stretch : data.states[i].stretches) motion.stretches_change |= stretch != 1.0;
  }
  motion.is_still = std::ranges::all_of(
      motion.states, [&](const ArmState& state) { return is_same(state, motion.states.front()); });
  motion.unsafe_moments = unsafe_moments(motion);
  motion.middle = nearest_index(motion.times, (motion.times.front() + motion.times.back()) / 2);
  return motion;
}

}  // namespace flexura
