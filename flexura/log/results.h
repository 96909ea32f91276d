#pragma once

#include <filesystem>

namespace flexura {

/// Makes the new folder `desired` and returns its path. If `desired` exists, makes `desired`-2, -3, ...
/// instead, because results are never overwritten. Makes missing parent folders too. Returns the new folder.
/// Throws std::runtime_error with the path on a system error.
[[nodiscard]] std::filesystem::path make_new_folder(const std::filesystem::path& desired);

/// Returns the default folder of an experiment's results: results/NAME. NAME is the name of the file, or the
/// name of its folder if the file's name is experiment.toml.
[[nodiscard]] std::filesystem::path default_results_folder(const std::filesystem::path& experiment_file);

// Names of the contents of a run's folder (docs/results.md); the last two are folders.
inline constexpr const char* experiment_file_name = "experiment.toml";
inline constexpr const char* log_file_name = "log.mcap";
inline constexpr const char* commands_file_name = "commands.csv";
inline constexpr const char* summary_file_name = "summary.json";
inline constexpr const char* rig_file_name = "rig.toml";
inline constexpr const char* timing_file_name = "timing.json";
inline constexpr const char* report_file_name = "report.html";
inline constexpr const char* figures_folder_name = "figures";
inline constexpr const char* tables_folder_name = "tables";

}  // namespace flexura
