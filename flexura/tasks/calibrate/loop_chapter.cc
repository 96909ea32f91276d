#include "flexura/tasks/calibrate/loop_chapter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/estimate/backbone_pixels.h"
#include "flexura/report/image_picture.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/calibrate/calibrate_table.h"
#include "flexura/tasks/photograph.h"

namespace flexura {
namespace {

// Returns a chart of the offsets of one camera over its loop's pictures, each while it is worked on.
ReportFigure falling_offsets(const CalibrationRun& run, std::size_t i, std::size_t number) {
  LineChart chart{.heading = fmt::format("offsets of camera {}", run.cameras[i]),
                  .x_label = "pictures of both cameras",
                  .value_label = "size",
                  .is_log = true};
  std::vector<const LoopDecision*> steps;
  std::vector<double>& looks = chart.x;
  for (const LoopDecision& step : run.loop->steps) {
    if (run.cameras[i] != run.nominal.cameras[step.camera].name || step.looks == 0) continue;
    steps.push_back(&step);
    const auto at = static_cast<double>(step.looks);
    if (looks.empty() || looks.back() < at) looks.push_back(at);
  }
  for (const LoopDecision* first : steps) {
    const std::string name = fmt::format("{} ({})", first->step, first->unit);
    if (std::ranges::find(chart.series, name, &ChartSeries::name) != chart.series.end()) continue;
    ChartSeries& series = chart.series.emplace_back(
        ChartSeries{name, std::vector(looks.size(), std::numeric_limits<double>::quiet_NaN())});
    std::size_t last = looks.size();
    for (const LoopDecision* step : steps) {
      if (step->step != first->step || step->unit != first->unit) continue;
      const auto place = static_cast<std::size_t>(std::ranges::find(looks, static_cast<double>(step->looks)) -
                                                  looks.begin());
      // Between two of its decisions an offset is constant, because others were worked on.
      for (std::size_t j = last; j < place; ++j) series.values[j] = series.values[last];
      constexpr double least = 1e-6;
      series.values[place] = std::log10(std::max(std::abs(step->offset), least));
      last = place;
    }
  }
  return {fmt::format("calibration-{}-offsets-{}", number + 1, run.cameras[i]), std::move(chart)};
}

ReportFigure loop_drawing(const CalibrationRun& run, std::size_t i, const char* what, std::size_t number,
                          ImagePlot plot) {
  plot.outlines.push_back({"picture's middle",
                           "s5",
                           {cross({0.5 * (plot.width - 1), 0.5 * (plot.height - 1)}, 0.03 * plot.width)}});
  return {fmt::format("calibration-{}-{}-{}", number + 1, run.cameras[i], what), image_picture(plot)};
}

ReportFigure loop_photograph(const CalibrationRun& run, std::size_t i, bool is_after, std::size_t number) {
  const char* when = is_after ? "after" : "before";
  return loop_drawing(run, i, when, number,
                      observed_picture(run, is_after ? *run.loop->after[i] : *run.loop->before[i],
                                       fmt::format("camera {}, {}", run.cameras[i], when)));
}

// Returns a drawing of the simulated arc of a camera.
ReportFigure ideal_drawing(const CalibrationRun& run, std::size_t i, std::size_t number) {
  const IdealArc& ideal = run.arcs[i].ideal;
  constexpr int count = 40;
  ImagePlot plot = photograph(
      ideal.picture, {},
      fmt::format("camera {}, ideal picture of the arc in the plane {}", run.cameras[i], ideal.plane));
  plot.outlines = {
      {"ideal axis", "s3", {{backbone_pixels(run.nominal.arm, ideal.state, ideal.view, count), "dash1"}}}};
  return loop_drawing(run, i, "ideal", number, std::move(plot));
}

// Returns a text with its bends, rotations and drive commands.
std::string arc_text(const CommandedArc& arc, const std::string& camera) {
  // In degrees; no zero is negative.
  const auto to_hundredths = [](double angle) {
    return fmt::format("{:.2f}", std::round(100 * angle / degree) / 100 + 0.0);
  };
  std::vector<std::string> bends, rotations;
  for (std::size_t i = 0; i < arc.rotations.size(); ++i) {
    bends.push_back(to_hundredths(arc.ideal.state.bends[i].norm()));
    rotations.push_back(to_hundredths(arc.rotations[i]));
  }
  return fmt::format(
      "The arc in the plane {}, for camera {}: sections bend by {} deg, in directions rotated by {} deg{}.",
      arc.ideal.plane, camera, fmt::join(bends, ", "), fmt::join(rotations, ", "),
      arc.positions ? fmt::format("; motors at {} microsteps", fmt::join(*arc.positions, ", ")) : "");
}

std::vector<std::string> loop_points(const CalibrationRun& run) {
  const LoopResult& result = *run.loop;
  std::vector<std::string> points;
  points.reserve(run.arcs.size() + 1);
  for (std::size_t i = 0; i < run.arcs.size(); ++i) points.push_back(arc_text(run.arcs[i], run.cameras[i]));
  for (std::size_t i = 0; i < 2; ++i)
    if (const auto& by = result.principal_point[i])
      points.push_back(
          fmt::format("The principal point of camera {} is {:.2f} px to the right of and {:.2f} px below its "
                      "position in the file{}.",
                      run.cameras[i], by->x(), by->y(),
                      result.is_done ? "; the rig file of this calibration has the new position" : ""));
  for (const std::string& note : result.notes) points.push_back(note);
  return points;
}

}  // namespace

Chapter loop_chapter(const CalibrationRun& run, std::size_t number) {
  const LoopResult& result = *run.loop;
  const std::size_t pictures = result.pictures[0] + result.pictures[1];
  Chapter chapter{"Calibration: " + run.name,
                  result.is_done ? fmt::format("Done with {} pictures.", pictures)
                                 : fmt::format("Not calibrated: {}. ({} pictures.)", result.reason, pictures),
                  {},
                  loop_points(run),
                  false};
  if (result.is_done) chapter.table = calibration_table(run);
  for (std::size_t i = 0; i < 2; ++i) {
    if (result.before[i]) chapter.figures.push_back(loop_photograph(run, i, false, number));
    if (result.after[i]) chapter.figures.push_back(loop_photograph(run, i, true, number));
  }
  for (std::size_t i = 0; i < run.arcs.size(); ++i) chapter.figures.push_back(ideal_drawing(run, i, number));
  for (std::size_t i = 0; i < 2; ++i) {
    const bool has_steps = std::ranges::any_of(result.steps, [&](const LoopDecision& step) {
      return step.looks > 0 && run.nominal.cameras[step.camera].name == run.cameras[i];
    });
    if (has_steps) chapter.figures.push_back(falling_offsets(run, i, number));
  }
  return chapter;
}

}  // namespace flexura
