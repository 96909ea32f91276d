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

/// The command list of a run: for every step of the clock the position each motor is to reach by then and its
/// mean step rate on the way, as a table and in the log (docs/results.md). The first row is where the motors
/// stand when the run starts.
class DriveCommands {
 public:
  /// Starts the new table `file`; std::system_error when it exists or cannot be written.
  DriveCommands(Arm arm, Drive drive, const std::filesystem::path& file);

  /// The arm's state that the motors are to reach by `time` s, later than the one before.
  void step(double time, const ArmState& state, Recorder& recorder);
  /// The motors' positions after the arm has gone on through these states.
  [[nodiscard]] std::vector<std::int64_t> positions_after(std::span<const ArmState> way) const;
  /// Completes the table.
  void close();

 private:
  void write_rows();

  Arm arm_;
  Drive drive_;
  AppendFile file_;
  CsvText rows_;  // not in the file yet
  double time_ = 0;
  std::optional<MotorCommander> commander_;  // from the first state on
};

}  // namespace flexura
