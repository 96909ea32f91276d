#pragma once

#include <filesystem>
#include <string>

#include "flexura/log/log_table.h"

namespace flexura {

/// Result of an export of a run's log.
struct ExportResult {
  std::filesystem::path folder;  ///< New folder with the tables.
  bool truncated = false;        ///< The run was cut short: its log ends without a summary.
};

/// Writes a run's log as tables into the new folder RESULTS/csv (csv-2, ... if it exists).
///
/// - `states.csv`: one row per commanded state (time; archings and cord angles of planar arms; bends,
///   stretches; base points and tip).
/// - `events.csv`: task starts, violations, the end.
/// - `truth.csv`: the true arm, for runs that play a rig.
/// - `tensions.csv`: for arms that are rods.
/// - `energy.csv`: for rods in motion.
/// - Tables of `more` with messages in the log (task_tables).
///
/// Throws InputError if `results` has no log, std::runtime_error if the log is corrupt or a file is not
/// writable.
ExportResult export_csv(const std::filesystem::path& results, LogTables more);

}  // namespace flexura
