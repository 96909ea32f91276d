#pragma once

#include <cstddef>
#include <string>

namespace flexura {

struct Setup;
class TaskRunner;

/// Name and position of a task in a file.
struct TaskLabel {
  std::string name;        ///< Name of the task, or its kind if the task has no name.
  std::size_t number = 0;  ///< Number of the task in the file, from 0.
};

}  // namespace flexura
