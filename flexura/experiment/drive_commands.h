#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "flexura/kinematics/motors.h"
#include "flexura/log/recorder.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/store/csv.h"
#include "flexura/store/mcap_file.h"

namespace flexura {

/// Command list of a run, as a table and in the log (docs/results.md). Each row has the positions of the
/// motors at a clock step, and their mean step rates since the previous clock step. The first row has the
/// motors' positions at the start of the run.
class DriveCommands {
 public:
  /// Starts the new table `file`. An empty `file` means no table. Throws std::system_error if the file exists
  /// or cannot be written.
  DriveCommands(Arm arm, Drive drive, const std::filesystem::path& file);

  /// Adds the arm's state that the motors must reach at `time` (s). Times must increase.
  void step(double time, const ArmState& state, Recorder& recorder);
  /// Returns the motors' positions after the arm has moved through these states.
  [[nodiscard]] std::vector<std::int64_t> positions_after(std::span<const ArmState> way) const;
  /// Completes the table.
  void close();

 private:
  void write_rows();

  Arm arm_;
  Drive drive_;
  std::optional<AppendFile> file_;  // Missing: only the log receives the commands.
  CsvText rows_;                    // Rows that are not yet in the file.
  double time_ = 0;
  std::optional<MotorCommander> commander_;  // Set with the first state.
};

}  // namespace flexura
