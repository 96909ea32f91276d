#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/node.h"
#include "flexura/report/image_picture.h"
#include "flexura/report/report.h"
#include "flexura/tasks/calibrate/calibrate_run.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// A calibrated rig, for experiments to include: the arm and the cameras, with initial positions where they
/// were sent.
struct FoundRigFile {
  ArmConfig arm;
  std::vector<CameraConfig> camera;
};
const Table<FoundRigFile>& fields_of(const FoundRigFile*);

/// Returns the file's text: TOML.
[[nodiscard]] std::string found_rig_toml(const Setup& setup, const CalibrationRun& run);

/// Writes rig.toml (rig-2.toml, ... if it exists) of a successful calibration into the results. If `saved_as`
/// is not empty, writes it beside the experiment too. An existing file there is kept as NAME-1.toml,
/// NAME-2.toml, ... Throws std::runtime_error with the path on a system error.
void write_rig_file(const Setup& setup, const CalibrationRun& run, const std::string& saved_as,
                    const std::filesystem::path& results);

/// Returns what came of it: of the method "bundle" the angle between the axes with its standard deviation,
/// and whether every required standard deviation is reached; of the paper's methods the angle as seen.
[[nodiscard]] TaskOutcome calibration_outcome(const CalibrationRun& run);

/// Returns its item in the list `calibrations` of a summary.
[[nodiscard]] Node calibration_node(const CalibrationRun& run);

/// Returns a picture with the measurements in it, and the axis as the ideal camera observes it.
[[nodiscard]] ImagePlot observed_picture(const CalibrationRun& run, const CameraObservation& observed,
                                         std::string heading);

/// Returns the calibration's chapter of a report: a table of the rig's errors before and after, charts,
/// pictures before and after. `number` from 0, for the names of figures.
[[nodiscard]] Chapter calibration_chapter(const CalibrationRun& run, std::size_t number);

}  // namespace flexura
