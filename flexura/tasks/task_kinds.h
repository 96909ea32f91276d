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

/// Configuration of one `[[task]]` of a file, of any kind. The header that declares the configuration of a
/// kind also declares its table of fields and the following functions, which the functions of this header
/// call:
///   void check_keys(const KIND&, const Setup&, const std::string& path, Reader&);
///   std::unique_ptr<TaskRunner> runner_of(const KIND&, const Setup&, TaskLabel);
/// Two further functions are optional:
///   void read_files(KIND&, const Setup&, const Node& written, const std::string& path,
///                   std::vector<Problem>&);
///   LogTables log_tables(const KIND*);
/// Summaries list the kinds of tasks in the order of this list.
using TaskConfig = std::variant<MoveTask, HoldTask, SineTask, KeyframesTask, ExpressionTask, StudyTask,
                                CalibrateTask, ServoTask, DynamicsTask>;

[[nodiscard]] std::string task_name(
    const TaskConfig& task);  ///< Returns the task's name, or its kind if it has no name.
[[nodiscard]] std::string_view task_kind(const TaskConfig& task);  ///< Returns the kind: "move", "servo", ...

/// Reports as errors why the task at `path` ("task[2]") does not fit the setup.
void check_task(const TaskConfig& task, const Setup& setup, const std::string& path, Reader& reader);

/// Reads the files that the task at `path` refers to, in the setup's folder or below. `written`: the task as
/// written in the experiment file. Adds errors in the read files to `problems`.
void read_task_files(TaskConfig& task, const Setup& setup, const Node& written, const std::string& path,
                     std::vector<Problem>& problems);

/// Returns the runner of a checked task. Task and setup must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> task_runner(const TaskConfig& task, const Setup& setup,
                                                      std::size_t number);

/// Returns the tables that `flexura export` makes from the tasks' messages in the log.
[[nodiscard]] LogTables task_tables();

}  // namespace flexura
