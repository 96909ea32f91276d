#include "flexura/report/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/kinematics/shape.h"
#include "flexura/report/arm_drawing.h"

namespace flexura {
namespace {

// A chart with a line for each section; `value` takes the state's and the section's index.
LineChart section_chart(const ReportMotion& motion, LineChart chart,
                        const std::function<double(std::size_t, std::size_t)>& value) {
  const std::size_t count = motion.arm.sections.size();
  const std::size_t shown = std::min(count, max_series);
  if (shown < count) chart.heading += fmt::format(" ({} of {} sections)", shown, count);
  chart.legend = "section";
  for (std::size_t k = 0; k < shown; ++k) {
    const std::size_t section = shown == 1 ? 0 : k * (count - 1) / (shown - 1);
    ChartSeries& series =
        chart.series.emplace_back(ChartSeries{fmt::format("{}", section + 1), section_class(section), {}});
    for (std::size_t i = 0; i < motion.count(); ++i) series.values.push_back(value(i, section));
  }
  return chart;
}

LineChart bend_chart(const ReportMotion& motion, int axis, const std::string& name) {
  const char letter = axis == 0 ? 'x' : 'y';
  return section_chart(
      motion,
      {name, fmt::format("bend_{} of each section", letter), fmt::format("bend_{} (deg)", letter), "", 1, {}},
      [&](std::size_t i, std::size_t k) { return motion.states[i].bends[k][axis] / degree; });
}

// A chart of what kinematics derives from each state, one angle a section.
LineChart angle_chart(const ReportMotion& motion, LineChart chart,
                      const std::function<std::vector<double>(const ArmState&)>& angles_of) {
  std::vector<std::vector<double>> angles;
  angles.reserve(motion.count());
  for (const ArmState& state : motion.states) angles.push_back(angles_of(state));
  return section_chart(motion, std::move(chart),
                       [&](std::size_t i, std::size_t k) { return angles[i][k] / degree; });
}

LineChart arching_chart(const ReportMotion& motion) {
  return angle_chart(motion, {"archings", "arching of each section", "arching (deg)", "", 1, {}}, archings);
}

LineChart cord_angle_chart(const ReportMotion& motion) {
  return angle_chart(motion,
                     {"cord-angles", "cord angle of each section", "cord angle from +X (deg)", "", 1, {}},
                     [&](const ArmState& state) { return cord_angles(motion.arm, state); });
}

LineChart stretch_chart(const ReportMotion& motion) {
  return section_chart(motion, {"stretches", "stretch of each section", "stretch (-)", "", 0.01, {}},
                       [&](std::size_t i, std::size_t k) { return motion.states[i].stretches[k]; });
}

LineChart tip_chart(const ReportMotion& motion) {
  LineChart chart = {"tip", "end effector", "coordinate (m)", "", 0.02 * motion.arm.length(), {}};
  for (int axis = 0; axis < (motion.in_plane ? 2 : 3); ++axis) {
    const char letter = "XYZ"[axis];
    ChartSeries& series =
        chart.series.emplace_back(ChartSeries{{letter}, fmt::format("axis-{}", letter), {}});
    for (std::size_t i = 0; i < motion.count(); ++i) series.values.push_back(motion.tip(i)[axis]);
  }
  return chart;
}

}  // namespace

std::vector<LineChart> charts_of(const ReportMotion& motion) {
  std::vector<LineChart> charts;
  if (motion.arm.kind == ArmKind::planar) {
    charts.push_back(bend_chart(motion, 0, "bends"));
    charts.push_back(arching_chart(motion));
  } else {
    charts.push_back(bend_chart(motion, 0, "bends-x"));
    charts.push_back(bend_chart(motion, 1, "bends-y"));
  }
  if (motion.has_cord_angles()) charts.push_back(cord_angle_chart(motion));
  if (motion.stretches_change) charts.push_back(stretch_chart(motion));
  charts.push_back(tip_chart(motion));
  return charts;
}

}  // namespace flexura
