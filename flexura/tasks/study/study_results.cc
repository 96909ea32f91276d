#include "flexura/tasks/study/study_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/log/results.h"
#include "flexura/store/csv.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

// Returns the text with "-" for all characters except ASCII letters, digits, "_" and inner ".", at most 100
// characters.
std::string file_name_of(std::string_view text) {
  std::string name;
  for (const char c : text.substr(0, 100)) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    const bool is_inner_dot = c == '.' && !name.empty();
    name += is_plain || c == '_' || is_inner_dot ? c : '-';
  }
  return name;
}

Node value_node(double value) { return std::isfinite(value) ? Node{value, {}} : Node{}; }

std::int64_t count_of(const ImageStudy& study, bool (ImageStudy::*is_so)(std::size_t) const) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < study.values.size(); ++i) count += (study.*is_so)(i) ? 1 : 0;
  return count;
}

}  // namespace

std::string study_csv(const ImageStudy& study) {
  CsvText csv;
  csv.cell(study.variation.name);
  for (const StudyColumn& column : study.columns)
    for (const std::string_view feature : feature_names)
      csv.cell(fmt::format("{}_{}", feature, column.source));
  csv.cell("in_image");
  csv.end_row();
  for (std::size_t i = 0; i < study.values.size(); ++i) {
    csv.cell(study.values[i]);
    for (const StudyColumn& column : study.columns) {
      for (const std::optional<double>& value : column.features[i]) value ? csv.cell(*value) : csv.cell("");
    }
    csv.cell(study.in_image(i) ? "1" : "0");
    csv.end_row();
  }
  return csv.text();
}

void write_study_table(ImageStudy& study, const std::filesystem::path& folder) {
  const std::filesystem::path tables = folder / tables_folder_name;
  std::filesystem::create_directory(tables);
  const std::string desired = file_name_of(study.name);
  study.name = desired;
  for (int i = 2; std::filesystem::exists(tables / (study.name + ".csv")); ++i)
    study.name = fmt::format("{}-{}", desired, i);
  write_new_file(tables / (study.name + ".csv"), study_csv(study));
}

TaskOutcome study_outcome(const ImageStudy& study) {
  const double length = study.largest_difference()[0];
  const auto [count, rms] = study.measured_difference();
  TaskOutcome outcome{.task = study.name,
                      .kind = "study",
                      .noun = "study",
                      .success = "agree with the renderer",
                      .is_reached = std::isfinite(length),
                      .text = {},
                      .size = {}};
  if (!outcome.is_reached) {
    outcome.text = "formulas and renderer disagree on what is visible";
    return outcome;
  }
  outcome.size = length;
  outcome.size_text = length < 0.001 ? "within 0.001 px" : fmt::format("within {:.2g} px", length);
  outcome.text = "formulas agree with the renderer " + outcome.size_text;
  if (count > 0)
    outcome.text +=
        fmt::format(", {} lengths measured in pictures have an error of {:.2g} px rms", count, rms);
  return outcome;
}

Node study_node(const ImageStudy& study) {
  const auto [length, ratio] = study.largest_difference();
  Node::Table entry{{"name", {}, {study.name, {}}},
                    {"camera", {}, {study.camera, {}}},
                    {"vary", {}, {std::string(study.variation.name), {}}},
                    {"from", {}, {study.variation.values[0], {}}},
                    {"to", {}, {study.variation.values[1], {}}},
                    {"points", {}, {static_cast<std::int64_t>(study.values.size()), {}}},
                    {"seen", {}, {count_of(study, &ImageStudy::is_seen), {}}},
                    {"in_image", {}, {count_of(study, &ImageStudy::in_image), {}}},
                    {"largest_difference_px", {}, value_node(length)},
                    {"largest_difference_axes_ratio", {}, value_node(ratio)}};
  if (const auto [count, rms] = study.measured_difference(); count > 0) {
    entry.push_back({"measured_lengths", {}, {static_cast<std::int64_t>(count), {}}});
    entry.push_back({"measured_rms_px", {}, value_node(rms)});
  }
  return {std::move(entry), {}};
}

}  // namespace flexura
