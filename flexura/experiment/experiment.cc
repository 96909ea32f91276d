#include "flexura/experiment/experiment.h"

#include <fmt/format.h>

#include "flexura/base/table.h"
#include "flexura/rig/setup_fields.h"

namespace flexura {
namespace {

constexpr std::size_t max_tasks = 10000;

void check_experiment(const Experiment& experiment, Reader& reader) {
  check_setup(experiment, reader);
  for (std::size_t i = 0; i < experiment.task.size(); ++i)
    check_task(experiment.task[i], experiment, fmt::format("task[{}]", i), reader);
}

}  // namespace

const Table<Experiment>& fields_of(const Experiment*) {
  static const auto table =
      with_setup_fields(
          Table<Experiment>("Flexura experiment file",
                            "A rig and its tasks. A file that has only the table [arm] describes an arm."))
          .field(
              "task", &Experiment::task,
              {.meaning = "Tasks, in order of execution.", .count = {0, max_tasks}, .default_text = "none"})
          .check(check_experiment);
  return table;
}

}  // namespace flexura
