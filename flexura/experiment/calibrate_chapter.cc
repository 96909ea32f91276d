#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "flexura/base/degree.h"
#include "flexura/camera/camera.h"
#include "flexura/experiment/calibrate_results.h"
#include "flexura/experiment/loop_chapter.h"
#include "flexura/experiment/photograph.h"
#include "flexura/report/chart.h"
#include "flexura/report/image_picture.h"

namespace flexura {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// What a chart shows of a value that falls over orders of magnitude.
double power_of_ten(double value) {
  constexpr double least = 1e-9;
  return std::isfinite(value) ? std::log10(std::max(std::abs(value), least)) : nothing;
}

class StepChart {
 public:
  StepChart(const CalibrationRun& run, LineChart chart) : run_(run), chart_(std::move(chart)) {
    chart_.x_label = "looks of both cameras";
  }

  // `first`: at no looks, by the rig as believed.
  template <class Value>
  StepChart& add(const std::string& name, double first, const Value& value) {
    ChartSeries& series = chart_.series.emplace_back(
        ChartSeries{name, fmt::format("s{}", chart_.series.size()), {power_of_ten(first)}, {}});
    for (const RigStep& step : run_.result.steps)
      series.values.push_back(step.is_found ? power_of_ten(value(step)) : nothing);
    return *this;
  }
  [[nodiscard]] NamedDrawing drawing(std::size_t number) const {
    std::vector<double> looks = {0};
    for (const RigStep& step : run_.result.steps) looks.push_back(static_cast<double>(step.looks));
    // The last look is calibrated by itself, so that no number of looks comes twice.
    return {fmt::format("calibration-{}-{}", number + 1, chart_.name), chart_picture(chart_, looks, {})};
  }

 private:
  const CalibrationRun& run_;
  LineChart chart_;
};

NamedDrawing offsets(const CalibrationRun& run, std::size_t number) {
  const RigRemainder first = run.result.believed_remainder.value_or(RigRemainder{});
  const double unknown = run.result.believed_remainder ? 1 : nothing;
  const auto of = [](const RigStep& step, const auto& value) {
    return step.remainder ? value(*step.remainder) : nothing;
  };
  const auto angle = [](const RigRemainder& left) { return left.angle / degree; };
  const auto aim = [](const RigRemainder& left) { return std::max(left.aim[0].norm(), left.aim[1].norm()); };
  const auto zoom = [](const RigRemainder& left) { return 100 * (left.zoom_ratio - 1); };
  return StepChart(run,
                   {"offsets", "what would have remained, if sent then", "size, power of ten", "", 1, {}, {}})
      .add("angle (deg)", unknown * angle(first), [&](const RigStep& step) { return of(step, angle); })
      .add("aim (m)", unknown * aim(first), [&](const RigStep& step) { return of(step, aim); })
      .add("zoom ratio (%)", unknown * zoom(first), [&](const RigStep& step) { return of(step, zoom); })
      .drawing(number);
}

NamedDrawing sigmas(const CalibrationRun& run, std::size_t number) {
  const auto share = [](double value) { return 100 * value; };
  return StepChart(
             run,
             {"sigmas", "how well it was known: standard deviations", "size, power of ten", "", 1, {}, {}})
      .add("angle (deg)", nothing, [](const RigStep& step) { return step.sigmas.angle / degree; })
      .add(run.cameras[0] + " focal (%)", nothing,
           [&](const RigStep& step) { return share(step.sigmas.focal[0]); })
      .add(run.cameras[1] + " focal (%)", nothing,
           [&](const RigStep& step) { return share(step.sigmas.focal[1]); })
      .add("zoom ratio (%)", nothing, [&](const RigStep& step) { return share(step.sigmas.zoom_ratio); })
      .drawing(number);
}

// With the optical axis as it was found.
NamedDrawing calibration_photograph(const CalibrationRun& run, std::size_t camera, bool is_after,
                                    std::size_t number) {
  const RigSight& sight = is_after ? *run.result.after[camera] : *run.result.before[camera];
  const char* when = is_after ? "after" : "before";
  ImagePlot plot = sight_picture(run, sight, fmt::format("camera {}, {}", run.cameras[camera], when));
  if (run.result.is_done) {
    const Intrinsics lens =
        Camera(run.result.found.model.cameras[sight.stance.camera]).lens().at(sight.stance.head.zoom);
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
      "pictures after it, what was measured was {:.2f} px and {:.2f} px from where it was foretold.",
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
  for (const std::string& note : result.wanted.notes) points.push_back(note);
  const auto& blind = result.observability.blindness;
  constexpr std::size_t most = 6;
  for (std::size_t i = 0; i < std::min(most, blind.size()); ++i)
    points.push_back(fmt::format("Not told by these pictures ({:.0f} % of what was not known is left): {}",
                                 100 * blind[i].share, blind[i].words));
  if (blind.size() > most)
    points.push_back(fmt::format("and {} more combinations, in summary.json", blind.size() - most));
  return points;
}

}  // namespace

ImagePlot sight_picture(const CalibrationRun& run, const RigSight& sight, std::string heading) {
  ImagePlot plot =
      photograph(*sight.frame.picture, run.believed.cameras[sight.stance.camera].sensor, std::move(heading));
  const bool is_arm = !run.is_before_etalon;
  ImageOutline line{is_arm ? "backbone" : "silhouette", "s2", {{}}},
      markers{is_arm ? "markers" : "red lines", "s1", {}};
  for (const CurvePoint& point : sight.seen.points) line.lines[0].points.push_back(point.pixel);
  if (!is_arm && !sight.seen.points.empty()) line.lines[0].points.push_back(sight.seen.points.front().pixel);
  for (const SeenMarker& marker : sight.seen.markers)
    markers.lines.push_back(cross(marker.pixel, 0.012 * plot.width));
  plot.outlines = {line, markers};
  if (sight.circle) plot.outlines.push_back({"circle", "s4", {circle_line(*sight.circle)}});
  if (const auto ideal = ideal_axis(run, sight); !ideal.empty())
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
    if (run.result.before[i]) chapter.drawings.push_back(calibration_photograph(run, i, false, number));
    if (run.result.is_done) chapter.drawings.push_back(calibration_photograph(run, i, true, number));
  }
  const bool is_known = std::ranges::any_of(run.result.steps, &RigStep::is_found);
  if (is_known) {
    chapter.drawings.push_back(offsets(run, number));
    chapter.drawings.push_back(sigmas(run, number));
  }
  return chapter;
}

}  // namespace flexura
