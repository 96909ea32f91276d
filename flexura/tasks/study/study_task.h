#pragma once

#include <memory>
#include <string>

#include "flexura/base/fields.h"
#include "flexura/study/study_config.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

// The keys of the kind "study" stand with what it does, in study/study_config.h.

/// Reports what keeps the study at `path` ("task[2]") from being made with this setup.
void check_keys(const StudyTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// What does such a task. Both outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const StudyTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
