#include "flexura/tasks/calibrate/calibrate_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/camera/camera.h"

namespace flexura {
namespace {

const std::vector<std::string> table_columns = {"quantity", "at the start", "after",
                                                "in truth", "tolerance",    "reached"};

std::string yes_no(bool is_so) { return is_so ? "yes" : "no"; }

// Returns a number with so many decimals; no zero is negative.
std::string decimals(double value, int count) {
  const double unit = std::pow(10.0, -count);
  return fmt::format("{:.{}f}", std::abs(value) < unit / 2 ? 0.0 : value, count);
}

using OfRemainder = std::function<double(const RigRemainder&)>;

// Adds a row of a quantity that a rig's remaining errors have.
void add_remainder(const CalibrationRun& run, const std::string& quantity, int places,
                   const OfRemainder& value, ChapterTable& table) {
  const RigSessionResult& result = run.result;
  table.rows.push_back({quantity, decimals(value(*result.start_remainder), places),
                        decimals(value(result.remainder), places),
                        run.truth ? decimals(value(*run.truth), places) : "", "", ""});
}

// Adds standard deviation and tolerance to the last row.
void add_tolerance(double sigma, double required, const char* unit, ChapterTable& table) {
  auto& row = table.rows.back();
  row[2] += fmt::format(" +- {:.2g}{}", sigma, unit);
  row[4] = fmt::format("+- {:.2g}{}", required, unit);
  row[5] = yes_no(sigma <= required);
}

// Returns the focal length of a camera at this lens position, px.
double focal_of(const CameraConfig& camera, double zoom) { return Camera(camera).lens().at(zoom).fx; }

void add_focal(const CalibrationRun& run, std::size_t i, ChapterTable& table) {
  const RigStance& stance = run.result.desired.stances[i];
  const double zoom = stance.head.zoom;
  table.rows.push_back({fmt::format("focal length of {} (px)", run.cameras[i]),
                        decimals(focal_of(run.nominal.cameras[stance.camera], zoom), 1),
                        decimals(focal_of(run.result.found.model.cameras[stance.camera], zoom), 1),
                        run.true_focal ? decimals((*run.true_focal)[i], 1) : "", "", ""});
  add_tolerance(100 * run.result.steps.back().sigmas.focal[i], 100 * run.required.focal[i], " %", table);
}

ChapterTable table_of_bundle(const CalibrationRun& run) {
  ChapterTable table{table_columns, {}};
  const RigSigmas& sigmas = run.result.steps.back().sigmas;
  add_remainder(
      run, "angle between the axes (deg)", 3,
      [](const RigRemainder& left) { return 90 + left.angle / degree; }, table);
  add_tolerance(sigmas.angle / degree, run.required.angle / degree, "", table);
  add_remainder(run, "zoom ratio", 4, [](const RigRemainder& left) { return left.zoom_ratio; }, table);
  add_tolerance(100 * sigmas.zoom_ratio, 100 * run.required.zoom_ratio, " %", table);
  for (std::size_t i = 0; i < 2; ++i) add_focal(run, i, table);
  for (std::size_t i = 0; i < 2; ++i)
    add_remainder(
        run, fmt::format("distance of the axis of {} from the target (mm)", run.cameras[i]), 2,
        [i](const RigRemainder& left) { return 1e3 * left.aim[i].norm(); }, table);
  for (std::size_t i = 0; i < 2; ++i)
    add_remainder(
        run, fmt::format("roll of {}, which no head can correct (deg)", run.cameras[i]), 2,
        [i](const RigRemainder& left) { return left.roll[i] / degree; }, table);
  for (std::size_t i = 0; i < 2; ++i)
    table.rows.push_back({fmt::format("prediction error in a new picture of {} (px)", run.cameras[i]), "",
                          decimals(run.result.verified[i], 2), "", "", ""});
  table.rows.push_back(
      {"RMS of the residuals, in standard deviations", "", decimals(run.result.found.rms, 2), "", "", ""});
  return table;
}

ChapterTable table_of_loop(const CalibrationRun& run) {
  const LoopResult& result = *run.loop;
  ChapterTable table{table_columns, {}};
  const auto add = [&](const std::string& quantity, int places, const std::optional<double>& seen,
                       const OfRemainder& truth) {
    if (!seen && !run.truth) return;
    table.rows.push_back({quantity, "", seen ? decimals(*seen, places) : "",
                          run.truth ? decimals(truth(*run.truth), places) : "", "", ""});
  };
  add("angle between the axes (deg)", 3,
      result.angle ? std::optional(90 + *result.angle / degree) : std::nullopt,
      [](const RigRemainder& left) { return 90 + left.angle / degree; });
  add("zoom ratio", 4, result.zoom_ratio, [](const RigRemainder& left) { return left.zoom_ratio; });
  for (std::size_t i = 0; i < 2; ++i)
    add(fmt::format("distance of the axis of {} from the target (mm)", run.cameras[i]), 2, std::nullopt,
        [i](const RigRemainder& left) { return 1e3 * left.aim[i].norm(); });
  for (std::size_t i = 0; i < 2; ++i)
    add(fmt::format("roll of {}, which no head can correct (deg)", run.cameras[i]), 2,
        result.roll[i] ? std::optional(*result.roll[i] / degree) : std::nullopt,
        [i](const RigRemainder& left) { return left.roll[i] / degree; });
  for (const LoopOffset& offset : loop_offsets(run))
    table.rows.push_back({offset.quantity, fmt::format("{:.3g}", offset.first->offset),
                          fmt::format("{:.3g}", offset.last->offset), "",
                          fmt::format("{:.3g}", offset.last->accepted), yes_no(offset.is_reached())});
  return table;
}

}  // namespace

std::vector<LoopOffset> loop_offsets(const CalibrationRun& run) {
  std::vector<LoopOffset> offsets;
  for (const LoopDecision& step : run.loop->steps) {
    if (step.looks == 0) continue;
    const std::string quantity =
        fmt::format("{} of {} ({})", step.step, run.nominal.cameras[step.camera].name, step.unit);
    auto found = std::ranges::find(offsets, quantity, &LoopOffset::quantity);
    if (found == offsets.end()) found = offsets.insert(found, LoopOffset{quantity, &step, nullptr});
    found->last = &step;
  }
  return offsets;
}

ChapterTable calibration_table(const CalibrationRun& run) {
  return run.loop ? table_of_loop(run) : table_of_bundle(run);
}

}  // namespace flexura
