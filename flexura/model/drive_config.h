#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive.h"

namespace flexura {

/// One tendon as the file describes it, `[[drive.tendon]]`. What is left out is the drive's.
struct TendonConfig {
  std::int64_t section = 1;      ///< The one at whose end it ends, counted from 1 at the base.
  double angle = 0;              ///< rad
  std::optional<double> radius;  ///< m
  bool reversed = false;         ///< As Axis::reversed.
  /// Of its own, whole: nothing of it is taken from the drive's.
  std::optional<StepperMotor> motor;
  std::optional<Spool> spool;
};

/// The table [drive] of a file.
struct DriveConfig {
  double radius = 0.015;              ///< m
  std::optional<std::int64_t> disks;  ///< As Drive::disks.
  std::int64_t axes_per_controller = 4;
  double pretension = 0;  ///< As Drive::pretension.
  /// Of tendons without one of their own.
  StepperMotor motor;
  Spool spool;
  std::vector<TendonConfig> tendon;  ///< Their order is that of the axes.

  /// The drive it describes.
  [[nodiscard]] Drive drive() const;
};

const Table<StepperMotor>& fields_of(const StepperMotor*);
const Table<Spool>& fields_of(const Spool*);
const Table<TendonConfig>& fields_of(const TendonConfig*);
const Table<DriveConfig>& fields_of(const DriveConfig*);

/// Reports to `reader` what keeps the drive at `path` from moving the arm: tendons that end at no section,
/// sections whose bend (and stretch, where its limits let it stretch) the tendons that end there do not
/// determine, and positions too fine to be counted.
void check_drive(const DriveConfig& config, const ArmConfig& arm, const std::string& path, Reader& reader);

}  // namespace flexura
