#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive.h"

namespace flexura {

/// One tendon in a file, `[[drive.tendon]]`. Omitted values are the drive's.
struct TendonConfig {
  std::int64_t section = 1;      ///< Section at whose end it ends, counted from 1 at the base.
  double angle = 0;              ///< rad.
  std::optional<double> radius;  ///< m.
  bool reversed = false;         ///< Axis::reversed.
  /// A complete motor or spool that replaces the drive's.
  std::optional<StepperMotor> motor;
  std::optional<Spool> spool;
};

/// The table [drive] of a file.
struct DriveConfig {
  double radius = 0.015;              ///< m.
  std::optional<std::int64_t> disks;  ///< Drive::disks.
  std::int64_t axes_per_controller = 4;
  double pretension = 0;  ///< Drive::pretension.
  /// Defaults for tendons without a motor or spool.
  StepperMotor motor;
  Spool spool;
  std::vector<TendonConfig> tendon;  ///< In the order of the axes.

  /// Returns the drive.
  [[nodiscard]] Drive drive() const;
};

const Table<StepperMotor>& fields_of(const StepperMotor*);
const Table<Spool>& fields_of(const Spool*);
const Table<TendonConfig>& fields_of(const TendonConfig*);
const Table<DriveConfig>& fields_of(const DriveConfig*);

/// Reports to `reader` why the drive at `path` cannot move the arm. Errors are tendons that end at no
/// section, sections whose bend (and stretch, if variable) their tendons do not determine, and positions
/// beyond the motor's count.
void check_drive(const DriveConfig& config, const ArmConfig& arm, const std::string& path, Reader& reader);

}  // namespace flexura
