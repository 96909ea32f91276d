#pragma once

#include <cstddef>
#include <string>

namespace flexura {

struct Setup;
class TaskRunner;

/// Name and position of a task in a file.
struct TaskLabel {
  std::string name;        ///< Its name, or its kind.
  std::size_t number = 0;  ///< From 0.
};

}  // namespace flexura
