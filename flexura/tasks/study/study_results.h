#pragma once

#include <filesystem>
#include <string>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/study/image_study.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Returns a study as CSV. The first column is the parameter (its name in the file, base units). Then come
/// the features by each source in turn ("top_formula", ..., "top_rendered", ...), px, and in_image (1 or 0).
/// Values that could not be measured are empty cells.
[[nodiscard]] std::string study_csv(const ImageStudy& study);

/// Writes the study's tables/NAME.csv into a results folder and sets the study's name. Its own name is kept
/// if it is a valid file name and unique among the previous studies. Throws std::runtime_error with the path
/// on a system error.
void write_study_table(ImageStudy& study, const std::filesystem::path& folder);

/// Returns what came of it: how well the formulas, the renderer and the pictures agree.
[[nodiscard]] TaskOutcome study_outcome(const ImageStudy& study);

/// Returns its item in the list `studies` of a summary.
[[nodiscard]] Node study_node(const ImageStudy& study);

/// Returns the chapter of a study in a report: the target in the image, and its features over the parameter.
[[nodiscard]] Chapter study_chapter(const ImageStudy& study);

}  // namespace flexura
