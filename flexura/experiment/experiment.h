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

/// An experiment file: a rig and its tasks, done one after another.
struct Experiment : Setup {
  std::vector<TaskConfig> task;  ///< Done in this order.
};

const Table<Experiment>& fields_of(const Experiment*);

/// Changes of a file by the command line, before it is read.
struct Overrides {
  std::vector<std::string> sets;     ///< "path=value" each, in TOML ("arm.section.0.length=2.5").
  std::optional<std::int64_t> seed;  ///< Replaces the file's.
};

/// Reads and checks an experiment (or only an arm: a file without tasks). Throws InputError with all
/// problems.
[[nodiscard]] Experiment load_experiment(const std::filesystem::path& file, const Overrides& overrides = {});

/// Reads and checks an experiment from TOML text, without includes and files of keyframes; `source` names it
/// in errors.
[[nodiscard]] Experiment parse_experiment(std::string_view text, const std::string& source,
                                          const Overrides& overrides = {});

/// Returns the experiment as a TOML file, with every value and default in base units.
[[nodiscard]] std::string experiment_toml(const Experiment& experiment);

}  // namespace flexura
