#pragma once

#include <memory>
#include <string>

#include "flexura/base/fields.h"
#include "flexura/study/study_config.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

// The keys of the kind "study" stand with what it does, in study/study_config.h.

void check_keys(const StudyTask& task, const Setup& setup, const std::string& path, Reader& reader);
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const StudyTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
