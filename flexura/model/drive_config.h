#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive.h"

namespace flexura {

/// One tendon in a file, `[[drive.tendon]]`. By default, the tendon has the radius, motor and spool of the
/// drive.
struct TendonConfig {
  std::int64_t section = 1;      ///< Section at the end of which the tendon ends, counted from 1 at the base.
  double angle = 0;              ///< Angle around the backbone, rad.
  std::optional<double> radius;  ///< Distance from the backbone, m.
  /// Whether positive microsteps let the cable out instead of pulling it in (Axis::reversed).
  bool reversed = false;
  /// Motor or spool of this tendon, instead of the drive's.
  std::optional<StepperMotor> motor;
  std::optional<Spool> spool;
};

/// The table [drive] of a file.
struct DriveConfig {
  double radius = 0.015;  ///< Distance from the backbone for tendons without a radius of their own, m.
  /// Number of equal pieces into which guide disks divide each section (Drive::disks).
  std::optional<std::int64_t> disks;
  std::int64_t axes_per_controller = 4;
  double pretension = 0;  ///< Tension of each tendon with all motors at position 0, N (Drive::pretension).
  /// Motor and spool of tendons without their own.
  StepperMotor motor;
  Spool spool;
  std::vector<TendonConfig> tendon;  ///< Tendons, in the order of their axes.

  /// Returns the drive that this table describes.
  [[nodiscard]] Drive drive() const;
};

const Table<StepperMotor>& fields_of(const StepperMotor*);
const Table<Spool>& fields_of(const Spool*);
const Table<TendonConfig>& fields_of(const TendonConfig*);
const Table<DriveConfig>& fields_of(const DriveConfig*);

/// Reports to `reader` why the drive at `path` cannot move the arm. Errors are a wrong section number of a
/// tendon, and motor positions too large for exact integers. A further error is a section whose tendons do
/// not determine its bend and its stretch (if variable).
void check_drive(const DriveConfig& config, const ArmConfig& arm, const std::string& path, Reader& reader);

}  // namespace flexura
