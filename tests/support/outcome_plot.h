#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/report/axes.h"
#include "flexura/report/svg.h"
#include "tests/support/calibration_trials.h"

namespace flexura {

using MethodTrials = std::vector<std::pair<std::string, std::vector<CalibrationTrial>>>;

/// Plots the starts of the trials, coloured by outcome, and the share of the starts that ended within an
/// angle.
class OutcomePlot {
 public:
  /// `shown`: trials whose starts are drawn; `all`: trials whose final angles are drawn.
  static std::string draw(const MethodTrials& shown, const MethodTrials& all) {
    OutcomePlot plot;
    double left = margin;
    for (const auto& [method, trials] : shown) {
      plot.draw_starts(method, trials, left);
      left += width + gap;
    }
    plot.draw_ends(all, left);
    return standalone_svg({.width = left + width + 20,
                           .height = plot.lowest_ + 10,
                           .label = "Starts and ends of calibrations",
                           .body = plot.svg_.text()});
  }

 private:
  static constexpr double margin = 60, width = 330, height = 300, gap = 80, top = heading_space + 6;
  static constexpr double in_degrees = 1 / degree;

  [[nodiscard]] PlotFrame start_plot(const std::string& heading, double left, Interval x, Interval y,
                                     const char* x_name, const char* y_name) {
    const PlotFrame frame{.x = x, .y = y, .corner = {left, top}, .size = {width, height}};
    draw_axes(svg_, frame, x_name, y_name);
    svg_.label({left, top - 12}, "heading", heading);
    return frame;
  }
  void end_plot(const std::vector<LegendEntry>& entries, const PlotFrame& frame) {
    const Eigen::Vector2d corner(frame.corner.x(), frame.bottom() + space_below_axes + 8);
    lowest_ = std::max(lowest_, corner.y() + draw_legend(svg_, "", entries, corner, frame.right() + 20));
  }

  // For example "done, 0.5 deg".
  static std::string outcome_of(const CalibrationTrial& trial) {
    if (!trial.is_done) return trial.reason;
    return trial.angle * in_degrees < 0.5 && trial.angle * in_degrees > -0.5 ? "done, within 0.5 deg"
                                                                             : "done, farther off";
  }

  void draw_starts(const std::string& method, const std::vector<CalibrationTrial>& trials, double left) {
    const PlotFrame frame = start_plot(method + ": where it starts", left, {0, 15}, {0, 0.36},
                                       "pan and tilt off (deg)", "stage off (m)");
    std::map<std::string, std::size_t> counts;
    for (const CalibrationTrial& trial : trials) ++counts[outcome_of(trial)];
    std::vector<std::pair<std::string, std::size_t>> kinds(counts.begin(), counts.end());
    std::ranges::stable_sort(kinds, std::greater{}, &std::pair<std::string, std::size_t>::second);
    std::vector<LegendEntry> entries;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const std::string color = "s" + std::to_string(i % 8);
      entries.push_back({kinds[i].first + ": " + std::to_string(kinds[i].second), "line " + color});
      for (const CalibrationTrial& trial : trials) {
        if (outcome_of(trial) != kinds[i].first) continue;
        const Eigen::Vector2d at = frame.page({trial.turn * in_degrees, trial.shift});
        svg_.circle(at, "dot " + color, 2);
      }
    }
    end_plot(entries, frame);
  }

  void draw_ends(const MethodTrials& methods, double left) {
    const PlotFrame frame = start_plot("what they reach", left, {-3, 1.5}, {0, 100},
                                       "log10 of the axes' angle from 90 deg, deg", "share of starts (%)");
    std::vector<LegendEntry> entries;
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const auto& [method, trials] = methods[i];
      std::vector<double> angles;
      for (const CalibrationTrial& trial : trials)
        if (trial.is_done)
          angles.push_back(std::clamp(std::log10(std::abs(trial.angle) * in_degrees + 1e-9), -3.0, 1.5));
      std::ranges::sort(angles);
      const double share = 100.0 / static_cast<double>(std::max<std::size_t>(trials.size(), 1));
      std::vector<Eigen::Vector2d> line = {frame.page({-3, 0})};
      for (std::size_t j = 0; j < angles.size(); ++j)
        line.push_back(frame.page({angles[j], share * static_cast<double>(j + 1)}));
      line.push_back(frame.page({1.5, share * static_cast<double>(angles.size())}));
      const std::string color = "s" + std::to_string(i);
      svg_.leaf("path", {{"class", "line " + color}, {"d", polyline_path(simplified(line, 0.3))}});
      entries.push_back({method, "line " + color});
    }
    end_plot(entries, frame);
  }

  XmlWriter svg_;
  double lowest_ = 0;
};

}  // namespace flexura
