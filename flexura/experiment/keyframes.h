#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/experiment/task_config.h"

namespace flexura {

/// What is wrong with a table of keyframes, and where: `row` counts data rows from 0; a row of -1 is the
/// header.
struct KeyframeProblem {
  std::ptrdiff_t row = -1;
  std::size_t column = 0;
  std::string what;
};

/// What keeps a task's columns and rows from being keyframes of an arm of this kind and number of sections.
[[nodiscard]] std::vector<KeyframeProblem> keyframe_problems(const KeyframesTask& task, ArmKind kind,
                                                             std::size_t sections);

/// The motion through the rows of a task without problems.
[[nodiscard]] MotionPtr keyframes_task_motion(const KeyframesTask& task, const Arm& arm);

}  // namespace flexura
