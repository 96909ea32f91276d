#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/log/log_table.h"

namespace flexura {

/// Result of an export of a run's log.
struct ExportResult {
  std::filesystem::path folder;    ///< New folder with the tables.
  std::vector<std::string> notes;  ///< What is missing in the log (log_notes).
};

/// Writes a run's log as tables into the new folder RESULTS/csv (csv-2, ... if it exists):
/// - states.csv: one row per commanded state (time; archings and cord angles of planar arms; bends,
/// stretches; base points and tip),
/// - events.csv: the events,
/// - truth.csv: the true arm, for runs that simulate a rig,
/// - contacts.csv: the contacts, for dynamic arms that touch something,
/// - tensions.csv: the tendons' tensions, for arms that are elastic rods,
/// - energy.csv: the arm's energies, for elastic rods with inertia,
/// - and each table of `more` for which the log has messages (task_tables).
/// `progress` may be null and cannot cancel the export. Throws InputError if `results` has no log, and
/// std::runtime_error if the log is corrupt or a file is not writable.
ExportResult export_csv(const std::filesystem::path& results, LogTables more, Progress* progress = nullptr);

}  // namespace flexura
