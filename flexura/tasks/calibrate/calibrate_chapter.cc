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
  LineChart chart{
      .heading = heading, .x_label = "looks of both cameras", .value_label = "size, power of ten", .x = {0}};
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
  LineChart chart = step_chart(run, "what would have remained, if sent then");
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
  LineChart chart = step_chart(run, "how well it was known: standard deviations");
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
  if (!result.is_done)
    return fmt::format("Not calibrated: {}. ({} looks, {} pictures.)", result.reason, result.looks,
                       result.pictures[0] + result.pictures[1]);
  const bool is_arm = !run.is_before_etalon;
  const std::string measured =
      is_arm ? fmt::format("{} markers and {} points of the median axis", result.markers, result.points)
             : fmt::format("{} points of its borders and red lines", result.etalon_points);
  return fmt::format(
      "{} looks of both cameras at the {}, {} pictures, in which {} were measured. The rig that explains "
      "them best leaves {:.2f} standard deviations root mean square. Heads, stages and zooms were then sent "
      "to where both cameras look at it along orthogonal axes with equal zoom, in one move. In fresh "
      "pictures after it the prediction errors were {:.2f} px and {:.2f} px.",
      result.looks, is_arm ? "arm" : "cylinder", result.pictures[0] + result.pictures[1], measured,
      result.found.rms, result.verified[0], result.verified[1]);
}

std::vector<std::string> points_of(const CalibrationRun& run) {
  const RigSessionResult& result = run.result;
  std::vector<std::string> points;
  if (!result.is_done) return points;
  points.push_back(remainder_text("At the start, as found", *result.start_remainder));
  points.push_back(remainder_text("After the move, as found", result.remainder));
  if (run.truth) points.push_back(remainder_text("After the move, in the simulated truth", *run.truth));
  const RigSigmas& sigmas = result.steps.back().sigmas;
  points.push_back(fmt::format(
      "Known (standard deviations): the angle between the axes within {:.4f} deg, focal lengths within "
      "{:.2f} % and {:.2f} %, zoom ratio within {:.2f} %.",
      sigmas.angle / degree, 100 * sigmas.focal[0], 100 * sigmas.focal[1], 100 * sigmas.zoom_ratio));
  for (const std::string& note : result.desired.notes) points.push_back(note);
  const auto& blind = result.observability.unobservable;
  constexpr std::size_t most = 6;
  for (std::size_t i = 0; i < std::min(most, blind.size()); ++i)
    points.push_back(
        fmt::format("Not observable in these pictures ({:.0f} % of the prior uncertainty is left): {}",
                    100 * blind[i].share, blind[i].words));
  if (blind.size() > most)
    points.push_back(fmt::format("and {} more combinations, in summary.json", blind.size() - most));
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

std::string remainder_text(const std::string& when, const RigRemainder& left) {
  return fmt::format(
      "{}: the axes are {:.3f} deg apart, pass the target by {:.2f} mm and {:.2f} mm, zoom ratio {:.4f}; "
      "roll about the axes, which no head can correct, {:.2f} deg and {:.2f} deg.",
      when, 90 + left.angle / degree, 1e3 * left.aim[0].norm(), 1e3 * left.aim[1].norm(), left.zoom_ratio,
      left.roll[0] / degree, left.roll[1] / degree);
}

Chapter calibration_chapter(const CalibrationRun& run, std::size_t number) {
  if (run.loop) return loop_chapter(run, number);
  Chapter chapter{"Calibration: " + run.name, text_of(run), {}, points_of(run), false};
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
