#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/rig/setup.h"
#include "flexura/tasks/task_kinds.h"

namespace flexura {

/// An experiment file: a rig and its tasks. The tasks are executed one after another.
struct Experiment : Setup {
  std::vector<TaskConfig> task;  ///< Tasks in the order of execution.
};

const Table<Experiment>& fields_of(const Experiment*);

/// Changes from the command line, which are made in a file before the check of the file.
struct Overrides {
  std::vector<std::string> sets;     ///< Changes "path=value" in TOML, such as "arm.section.0.length=2.5".
  std::optional<std::int64_t> seed;  ///< Seed that replaces the file's seed.
};

/// Reads and checks an experiment. The file may have no tasks and describe only an arm. Throws InputError
/// with all problems.
[[nodiscard]] Experiment load_experiment(const std::filesystem::path& file, const Overrides& overrides = {});

/// Reads and checks an experiment from TOML text. The text must not refer to other files. `source`: name of
/// the text in errors.
[[nodiscard]] Experiment parse_experiment(std::string_view text, const std::string& source,
                                          const Overrides& overrides = {});

/// Returns the experiment as a TOML file, with every value and default in base units.
[[nodiscard]] std::string experiment_toml(const Experiment& experiment);

}  // namespace flexura
