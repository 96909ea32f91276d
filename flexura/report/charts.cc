#include "flexura/report/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/kinematics/shape.h"
#include "flexura/report/axes.h"

namespace flexura {
namespace {

class MotionCharts {
 public:
  explicit MotionCharts(const ReportMotion& motion) : motion_(motion) {}

  // Adds a chart with a line for each section; `values` returns one number per section.
  void add_sections(const std::string& name, const std::string& quantity, const std::string& label,
                    double least, const std::function<std::vector<double>(const ArmState&)>& values) {
    const std::size_t count = motion_.arm.sections.size();
    const std::size_t shown = std::min(count, max_series);
    LineChart& chart = add(name, quantity + " of each section", label, least);
    if (shown < count) chart.heading += fmt::format(" ({} of {} sections)", shown, count);
    chart.legend = "section";
    std::vector<std::vector<double>> all;
    all.reserve(motion_.states.size());
    for (const ArmState& state : motion_.states) all.push_back(values(state));
    for (std::size_t k = 0; k < shown; ++k) {
      const std::size_t section = shown == 1 ? 0 : k * (count - 1) / (shown - 1);
      ChartSeries& series = chart.series.emplace_back(ChartSeries{
          .name = fmt::format("{}", section + 1), .values = {}, .css_class = line_class(section)});
      for (const std::vector<double>& each : all) series.values.push_back(each[section]);
    }
  }

  void add_tip() {
    LineChart& chart = add("tip", "end effector", "coordinate (m)", 0.02 * motion_.arm.length());
    for (int axis = 0; axis < (motion_.in_plane ? 2 : 3); ++axis) {
      ChartSeries& series = chart.series.emplace_back(
          ChartSeries{.name = {"XYZ"[axis]}, .values = {}, .css_class = fmt::format("axis dash{}", axis)});
      for (std::size_t i = 0; i < motion_.count(); ++i) series.values.push_back(motion_.tip(i)[axis]);
    }
  }

  std::vector<ReportFigure> charts;

 private:
  LineChart& add(const std::string& name, std::string heading, const std::string& label, double least) {
    charts.push_back({name, LineChart{.heading = std::move(heading),
                                      .x_label = "t (s)",
                                      .value_label = label,
                                      .least = least,
                                      .x = motion_.times,
                                      .is_of_run = true,
                                      .marks = motion_.event_times}});
    return std::get<LineChart>(charts.back().content);
  }

  const ReportMotion& motion_;
};

std::vector<double> degrees(std::vector<double> angles) {
  for (double& angle : angles) angle /= degree;
  return angles;
}

}  // namespace

std::vector<ReportFigure> charts_of(const ReportMotion& motion) {
  const bool is_planar = motion.arm.kind == ArmKind::planar;
  MotionCharts all(motion);
  for (int axis = 0; axis < (is_planar ? 1 : 2); ++axis) {
    const std::string letter(1, "xy"[axis]);
    all.add_sections(is_planar ? "bends" : "bends-" + letter, "bend_" + letter, "bend_" + letter + " (deg)",
                     1, [axis](const ArmState& state) {
                       std::vector<double> bends;
                       bends.reserve(state.bends.size());
                       for (const Eigen::Vector2d& bend : state.bends) bends.push_back(bend[axis]);
                       return degrees(bends);
                     });
  }
  if (is_planar)
    all.add_sections("archings", "arching", "arching (deg)", 1,
                     [](const ArmState& state) { return degrees(archings(state)); });
  if (motion.has_cord_angles())
    all.add_sections("cord-angles", "cord angle", "cord angle from +X (deg)", 1,
                     [&](const ArmState& state) { return degrees(cord_angles(motion.arm, state)); });
  if (motion.stretches_change)
    all.add_sections("stretches", "stretch", "stretch (-)", 0.01,
                     [](const ArmState& state) { return state.stretches; });
  all.add_tip();
  return std::move(all.charts);
}

}  // namespace flexura
