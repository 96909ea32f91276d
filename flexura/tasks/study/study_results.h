#pragma once

#include <filesystem>
#include <string>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/study/image_study.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Returns a study as CSV. The first column is the parameter, with its name in the file, in base units. The
/// features from each source follow ("top_formula", ..., "top_rendered", ...), px. The last column, in_image
/// (1 or 0), states whether the target is within the image. Values that could not be measured are empty
/// cells.
[[nodiscard]] std::string study_csv(const ImageStudy& study);

/// Writes the study's tables/NAME.csv into a results folder. Sets the study's name to a new one if it is not
/// a valid file name or a previous study has it. Throws std::runtime_error with the path on a system error.
void write_study_table(ImageStudy& study, const std::filesystem::path& folder);

/// Returns the result of the study in words: how well the formulas, the renderer and the pictures agree.
[[nodiscard]] TaskOutcome study_outcome(const ImageStudy& study);

/// Returns the study's item in the list `studies` of a summary.
[[nodiscard]] Node study_node(const ImageStudy& study);

/// Returns the report's chapter of a study: the target in the image, and plots of the target's features
/// against the parameter.
[[nodiscard]] Chapter study_chapter(const ImageStudy& study);

}  // namespace flexura
