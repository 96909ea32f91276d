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

/// A calibrated rig that experiments can include: the arm, and the cameras with their final commanded
/// positions as initial positions.
struct FoundRigFile {
  ArmConfig arm;
  std::vector<CameraConfig> camera;
};
const Table<FoundRigFile>& fields_of(const FoundRigFile*);

/// Returns the text of the file in TOML.
[[nodiscard]] std::string found_rig_toml(const Setup& setup, const CalibrationRun& run);

/// Writes the rig of a successful calibration into the results folder as rig.toml (rig-2.toml, ... if it
/// exists). If `saved_as` is not empty, also writes a copy with this name into the experiment's folder. An
/// existing file with this name is renamed to NAME-1.toml, NAME-2.toml, ... Throws std::runtime_error with
/// the path on a system error.
void write_rig_file(const Setup& setup, const CalibrationRun& run, const std::string& saved_as,
                    const std::filesystem::path& results);

/// Returns the result of a calibration in words. For the method "bundle", the text states the standard
/// deviation of the angle between the axes, and whether all required standard deviations are reached. For the
/// paper's methods, the text states the observed angle.
[[nodiscard]] TaskOutcome calibration_outcome(const CalibrationRun& run);

/// Returns the calibration's item in the list `calibrations` of a summary.
[[nodiscard]] Node calibration_node(const CalibrationRun& run);

/// Returns a plot of a picture with its measurements, and with the arm's axis as an ideal camera would
/// observe it.
[[nodiscard]] ImagePlot observed_picture(const CalibrationRun& run, const CameraObservation& observed,
                                         std::string heading);

/// Returns the report's chapter on a calibration. The chapter has a table of the rig's errors before and
/// after the calibration, charts, and pictures from before and after. `number`: index among the calibrations,
/// from 0, for names of figures.
[[nodiscard]] Chapter calibration_chapter(const CalibrationRun& run, std::size_t number);

}  // namespace flexura
