#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/experiment/experiment.h"
#include "flexura/report/report.h"
#include "flexura/study/image_study.h"

namespace flexura {

/// The studies of an experiment's tasks, in their order. Names that cannot be file names are changed to ones
/// that can, and no two are the same.
[[nodiscard]] std::vector<ImageStudy> studies_of(const Experiment& experiment);

/// A study as CSV: the parameter (its name in the file, base units), the features by each source in turn
/// ("top_formula", ..., "top_rendered", ...), px, and in_image (1 or 0). What could not be measured is an
/// empty cell.
[[nodiscard]] std::string study_csv(const ImageStudy& study);

/// Writes tables/NAME.csv of each study into a results folder; std::runtime_error with the path when the
/// system refuses.
void write_study_tables(const std::vector<ImageStudy>& studies, const std::filesystem::path& folder);

/// The list `studies` of a summary.
[[nodiscard]] Node study_nodes(const std::vector<ImageStudy>& studies);

/// A study in a report: the target in the image, and its features over the parameter.
[[nodiscard]] Chapter study_chapter(const ImageStudy& study);

}  // namespace flexura
