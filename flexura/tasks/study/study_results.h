#pragma once

#include <filesystem>
#include <string>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/study/image_study.h"

namespace flexura {

/// A study as CSV: the parameter (its name in the file, base units), the features by each source in turn
/// ("top_formula", ..., "top_rendered", ...), px, and in_image (1 or 0). What could not be measured is an
/// empty cell.
[[nodiscard]] std::string study_csv(const ImageStudy& study);

/// Writes the study's tables/NAME.csv into a results folder, and names the study so: as it is called where
/// that can be a file's name, and otherwise than the studies before. std::runtime_error with the path when
/// the system refuses.
void write_study_table(ImageStudy& study, const std::filesystem::path& folder);

/// Its entry in the list `studies` of a summary.
[[nodiscard]] Node study_node(const ImageStudy& study);

/// A study in a report: the target in the image, and its features over the parameter.
[[nodiscard]] Chapter study_chapter(const ImageStudy& study);

}  // namespace flexura
