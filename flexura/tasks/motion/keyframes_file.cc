#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/rig/setup.h"
#include "flexura/store/csv_reader.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"
#include "flexura/tasks/motion/keyframes.h"

namespace flexura {
namespace {

// Positions of the cells of a table's lines in its text; fast for lines in increasing order.
class CellPlaces {
 public:
  explicit CellPlaces(std::string_view text) : text_(text), rest_(text) {}

  // Line and result are from 1, the cell from 0.
  int column(int line, std::size_t cell) {
    if (line < line_) line_ = 1, rest_ = text_;
    for (; line_ < line; ++line_) rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size() - 1) + 1);
    const std::vector<int> columns = cell_columns(rest_.substr(0, rest_.find('\n')));
    return cell < columns.size() ? columns[cell] : 1;
  }

 private:
  std::string_view text_, rest_;
  int line_ = 1;
};

// Reads the CSV file of a keyframes task into the task.
void read_keyframes(KeyframesTask& task, const ArmConfig& arm, const std::filesystem::path& folder) {
  const std::filesystem::path file = file_inside(folder, task.file);
  const std::string name = file.string();
  const std::string text = read_text_file(file, max_toml_bytes);
  NumberTable table = parse_csv(text, name);
  task.columns = std::move(table.columns);
  task.rows = std::move(table.rows);
  task.file.clear();
  const auto source = std::make_shared<const std::string>(name);
  std::vector<Problem> problems;
  CellPlaces places(text);
  for (const KeyframeProblem& problem : keyframe_problems(task, arm.kind, arm.section.size())) {
    const int line = problem.row < 0 ? table.header_line : table.lines[static_cast<std::size_t>(problem.row)];
    Problem& reported = problems.emplace_back();
    reported.where = {source, line, problem.row == all_rows ? 1 : places.column(line, problem.column)};
    if (problem.row >= 0) reported.what = fmt::format("column {}: ", task.columns[problem.column]);
    reported.what += problem.what;
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

void read_files(KeyframesTask& task, const Setup& setup, const Node& /*written*/, const std::string& /*path*/,
                std::vector<Problem>& problems) {
  if (task.file.empty()) return;
  try {
    read_keyframes(task, setup.arm, setup.folder);
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
}

}  // namespace flexura
