#pragma once

#include <cstddef>
#include <string>

namespace flexura {

struct Setup;
class TaskRunner;

/// What a task of a file is called, and where it stands.
struct TaskLabel {
  std::string name;        ///< Its own, or its kind.
  std::size_t number = 0;  ///< From 0.
};

}  // namespace flexura
