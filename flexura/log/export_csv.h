#pragma once

#include <filesystem>
#include <string>

#include "flexura/log/log_table.h"

namespace flexura {

/// What an export made of a run's log.
struct ExportResult {
  std::filesystem::path folder;  ///< The new one, with the tables.
  bool truncated = false;        ///< The run was cut short: its log ended without a summary.
};

/// Writes a run's log as tables into the new folder RESULTS/csv (csv-2, ... when it exists): states.csv with
/// a row a state (time; archings and cord angles of planar arms; bends, stretches; base points and tip) as
/// commanded, events.csv, truth.csv of runs that play a rig (the arm as it was), tensions.csv of arms that
/// are rods, energy.csv of rods in motion, and those of `more` of which the log has something (task_tables).
/// Throws InputError when `results` holds no log, std::runtime_error when the log is corrupt or a file not
/// writable.
ExportResult export_csv(const std::filesystem::path& results, LogTables more);

}  // namespace flexura
