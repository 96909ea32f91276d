#pragma once

#include <memory>
#include <string>

#include "flexura/base/fields.h"
#include "flexura/study/study_config.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

// The keys of the kind "study" are in study/study_config.h.

/// Reports why the study at `path` ("task[2]") is impossible with this setup.
void check_keys(const StudyTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Returns the runner of such a task. Both arguments must outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const StudyTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
