#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "flexura/base/degree.h"
#include "flexura/camera/camera.h"
#include "flexura/report/image_picture.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/calibrate/calibrate_table.h"
#include "flexura/tasks/calibrate/loop_chapter.h"
#include "flexura/tasks/photograph.h"

namespace flexura {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// Returns the value for charts of values that fall over orders of magnitude.
double power_of_ten(double value) {
  constexpr double least = 1e-9;
  return std::isfinite(value) ? std::log10(std::max(std::abs(value), least)) : nothing;
}

// Returns a chart of values that fall from look to look. The last look is calibrated separately, so that no
// number of looks repeats.
LineChart step_chart(const CalibrationRun& run, const char* heading) {
  LineChart chart{.heading = heading,
                  .x_label = "views of both cameras",
                  .value_label = "size",
                  .x = {0},
                  .is_log = true};
  for (const RigStep& step : run.result.steps) chart.x.push_back(static_cast<double>(step.looks));
  return chart;
}

// `first`: the value at no looks, from the nominal rig.
template <class Value>
void add_line(LineChart& chart, const CalibrationRun& run, const std::string& name, double first,
              const Value& value) {
  ChartSeries& series = chart.series.emplace_back(ChartSeries{name, {power_of_ten(first)}});
  for (const RigStep& step : run.result.steps)
    series.values.push_back(step.is_found ? power_of_ten(value(step)) : nothing);
}

ReportFigure offsets(const CalibrationRun& run, std::size_t number) {
  LineChart chart = step_chart(run, "errors that would remain if the result were commanded after this view");
  const auto add = [&](const char* name, const auto& value) {
    const auto of = [&](const auto& left) { return left ? value(*left) : nothing; };
    add_line(chart, run, name, of(run.result.nominal_remainder),
             [&](const RigStep& step) { return of(step.remainder); });
  };
  add("angle (deg)", [](const RigRemainder& left) { return left.angle / degree; });
  add("aim (m)", [](const RigRemainder& left) { return std::max(left.aim[0].norm(), left.aim[1].norm()); });
  add("zoom ratio (%)", [](const RigRemainder& left) { return 100 * (left.zoom_ratio - 1); });
  return {fmt::format("calibration-{}-offsets", number + 1), std::move(chart)};
}

ReportFigure sigmas(const CalibrationRun& run, std::size_t number) {
  LineChart chart = step_chart(run, "standard deviations of the estimate");
  const auto add = [&](const std::string& name, const auto& value) {
    add_line(chart, run, name, nothing, [&](const RigStep& step) { return value(step.sigmas); });
  };
  add("angle (deg)", [](const RigSigmas& known) { return known.angle / degree; });
  for (std::size_t i = 0; i < 2; ++i)
    add(run.cameras[i] + " focal (%)", [i](const RigSigmas& known) { return 100 * known.focal[i]; });
  add("zoom ratio (%)", [](const RigSigmas& known) { return 100 * known.zoom_ratio; });
  return {fmt::format("calibration-{}-sigmas", number + 1), std::move(chart)};
}

// Includes the optical axis as found.
ReportFigure calibration_photograph(const CalibrationRun& run, std::size_t camera, bool is_after,
                                    std::size_t number) {
  const CameraObservation& observed = is_after ? *run.result.after[camera] : *run.result.before[camera];
  const char* when = is_after ? "after" : "before";
  ImagePlot plot = observed_picture(run, observed, fmt::format("camera {}, {}", run.cameras[camera], when));
  if (run.result.is_done) {
    const Intrinsics lens =
        Camera(run.result.found.model.cameras[observed.stance.camera]).lens().at(observed.stance.head.zoom);
    plot.outlines.push_back({"optical axis", "s5", {cross({lens.cx, lens.cy}, 0.036 * plot.width)}});
  }
  return {fmt::format("calibration-{}-{}-{}", number + 1, run.cameras[camera], when), image_picture(plot)};
}

ImageOutline::Line circle_line(const CircleFit& circle) {
  ImageOutline::Line line;
  constexpr int sides = 72;
  for (int i = 0; i <= sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    line.points.emplace_back(circle.center +
                             circle.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return line;
}

std::string text_of(const CalibrationRun& run) {
  const RigSessionResult& result = run.result;
  const std::size_t pictures = result.pictures[0] + result.pictures[1];
  if (!result.is_done)
    return fmt::format("Not calibrated: {}. ({} views, {} pictures.)", result.reason, result.looks, pictures);
  const std::string measured =
      run.is_before_etalon
          ? fmt::format("cylinder: {} points of its borders and red lines", result.etalon_points)
          : fmt::format("arm: {} markers and {} points of its axis", result.markers, result.points);
  return fmt::format(
      "{} views by both cameras, {} pictures of the {}. +- is a standard deviation. The values at the start "
      "and after the calibration are estimates.",
      result.looks, pictures, measured);
}

// Returns what the pictures do not determine.
std::vector<std::string> unknowns_of(const CalibrationRun& run) {
  std::vector<std::string> points;
  points.reserve(run.result.observability.unobservable.size());
  for (const UnobservableDirection& blind : run.result.observability.unobservable)
    points.push_back(
        fmt::format("{:.0f} % of the prior standard deviation remains: {}", 100 * blind.share, blind.words));
  return points;
}

}  // namespace

ImagePlot observed_picture(const CalibrationRun& run, const CameraObservation& observed,
                           std::string heading) {
  ImagePlot plot = photograph(*observed.frame.picture, run.nominal.cameras[observed.stance.camera].sensor,
                              std::move(heading));
  const bool is_arm = !run.is_before_etalon;
  ImageOutline line{is_arm ? "backbone" : "silhouette", "s2", {{}}},
      markers{is_arm ? "markers" : "red lines", "s1", {}};
  for (const CurvePoint& point : observed.seen.points) line.lines[0].points.push_back(point.pixel);
  if (!is_arm && !observed.seen.points.empty())
    line.lines[0].points.push_back(observed.seen.points.front().pixel);
  for (const SeenMarker& marker : observed.seen.markers)
    markers.lines.push_back(cross(marker.pixel, 0.012 * plot.width));
  plot.outlines = {line, markers};
  if (observed.circle) plot.outlines.push_back({"circle", "s4", {circle_line(*observed.circle)}});
  if (const auto ideal = ideal_axis(run, observed); !ideal.empty())
    plot.outlines.push_back({"ideal axis", "s3", {{ideal, "dash1"}}});
  return plot;
}

Chapter calibration_chapter(const CalibrationRun& run, std::size_t number) {
  if (run.loop) return loop_chapter(run, number);
  Chapter chapter{
      .heading = "Calibration: " + run.name, .text = text_of(run), .figures = {}, .is_first_tall = false};
  if (run.result.is_done) {
    chapter.table = calibration_table(run);
    chapter.points = run.result.desired.notes;
    chapter.details = {"What these pictures do not determine", unknowns_of(run)};
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (run.result.before[i]) chapter.figures.push_back(calibration_photograph(run, i, false, number));
    if (run.result.is_done) chapter.figures.push_back(calibration_photograph(run, i, true, number));
  }
  const bool is_known = std::ranges::any_of(run.result.steps, &RigStep::is_found);
  if (is_known) {
    chapter.figures.push_back(offsets(run, number));
    chapter.figures.push_back(sigmas(run, number));
  }
  return chapter;
}

}  // namespace flexura
