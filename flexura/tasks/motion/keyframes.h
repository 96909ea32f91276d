#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/tasks/motion/motion_task_config.h"

namespace flexura {

/// Special values of KeyframeProblem::row: they stand for the row of column names, and for the whole table.
inline constexpr std::ptrdiff_t header_row = -1;
inline constexpr std::ptrdiff_t all_rows = -2;

/// An error in a table of keyframes and its position. `row` counts data rows from 0.
struct KeyframeProblem {
  std::ptrdiff_t row = header_row;
  std::size_t column = 0;
  std::string what;
};

/// Returns the errors in a task's columns and rows for an arm of this kind and number of sections.
[[nodiscard]] std::vector<KeyframeProblem> keyframe_problems(const KeyframesTask& task, ArmKind kind,
                                                             std::size_t sections);

/// Returns the motion through the rows of a valid task.
[[nodiscard]] MotionPtr keyframes_task_motion(const KeyframesTask& task, const Arm& arm);

}  // namespace flexura
