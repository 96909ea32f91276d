#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/source.h"
#include "flexura/log/log_table.h"
#include "flexura/tasks/calibrate/calibrate_config.h"
#include "flexura/tasks/dynamics/dynamics_task_config.h"
#include "flexura/tasks/motion/motion_task_config.h"
#include "flexura/tasks/servo/servo_task_config.h"
#include "flexura/tasks/study/study_task.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

/// One `[[task]]` of a file: the list of all kinds. Of each, its header of keys declares, beside its table of
/// fields,
///   void check_keys(const KIND&, const Setup&, const std::string& path, Reader&)
///   std::unique_ptr<TaskRunner> runner_of(const KIND&, const Setup&, TaskLabel)
/// and, where it has some,
///   void read_files(KIND&, const Setup&, const Node& written, const std::string& path,
///                   std::vector<Problem>&)
///   LogTables log_tables(const KIND*)
/// which are what the functions below ask for.
/// Summaries have the kinds in this order.
using TaskConfig = std::variant<MoveTask, HoldTask, SineTask, KeyframesTask, ExpressionTask, StudyTask,
                                CalibrateTask, ServoTask, DynamicsTask>;

[[nodiscard]] std::string task_name(const TaskConfig& task);       ///< Its name, else its kind.
[[nodiscard]] std::string_view task_kind(const TaskConfig& task);  ///< "move", "servo", ...

/// Reports what keeps the task at `path` ("task[2]") from fitting the setup.
void check_task(const TaskConfig& task, const Setup& setup, const std::string& path, Reader& reader);

/// Reads the files that the task at `path`, `written` so, names, from the setup's folder or below; what is
/// wrong with them is added to the problems.
void read_task_files(TaskConfig& task, const Setup& setup, const Node& written, const std::string& path,
                     std::vector<Problem>& problems);

/// What does a task that was checked. Both outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> task_runner(const TaskConfig& task, const Setup& setup,
                                                      std::size_t number);

/// The tables that exports make of what tasks tell.
[[nodiscard]] LogTables task_tables();

}  // namespace flexura
