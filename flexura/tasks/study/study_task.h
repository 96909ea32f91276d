#pragma once

#include <memory>
#include <string>

#include "flexura/base/fields.h"
#include "flexura/study/study_config.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

// The fields of a task of kind "study" are in study/study_config.h.

/// Reports as errors why the study at `path` ("task[2]") is impossible with this setup.
void check_keys(const StudyTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Returns the runner of a study. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const StudyTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
