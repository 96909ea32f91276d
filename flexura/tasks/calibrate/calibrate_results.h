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

namespace flexura {

/// A rig as it was found, for experiments to include: the arm and the cameras, which start where they were
/// sent.
struct FoundRigFile {
  ArmConfig arm;
  std::vector<CameraConfig> camera;
};
const Table<FoundRigFile>& fields_of(const FoundRigFile*);

/// The file's text: TOML.
[[nodiscard]] std::string found_rig_toml(const Setup& setup, const CalibrationRun& run);

/// Writes rig.toml (rig-2.toml, ... where there is one) of a calibration that is done into the results, and
/// where `saved_as` is no empty name that beside the experiment: a file that is there already is kept as
/// NAME-1.toml, NAME-2.toml, ... std::runtime_error with the path when the system refuses.
void write_rig_file(const Setup& setup, const CalibrationRun& run, const std::string& saved_as,
                    const std::filesystem::path& results);

/// Its entry in the list `calibrations` of a summary.
[[nodiscard]] Node calibration_node(const CalibrationRun& run);

/// A picture with what was seen in it, and where the ideal camera would see the axis.
[[nodiscard]] ImagePlot sight_picture(const CalibrationRun& run, const RigSight& sight, std::string heading);

/// What remains, in a sentence that begins with `when`.
[[nodiscard]] std::string remainder_text(const std::string& when, const RigRemainder& left);

/// A calibration in a report: how far off the rig was and became, how well it is known, what the cameras saw
/// before and after. `number` from 0, for the names of figures.
[[nodiscard]] Chapter calibration_chapter(const CalibrationRun& run, std::size_t number);

}  // namespace flexura
