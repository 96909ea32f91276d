#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/equipment/cia402_drive.h"
#include "flexura/equipment/device_access.h"
#include "flexura/equipment/grbl_drive.h"
#include "flexura/equipment/guarded_drive.h"
#include "flexura/equipment/joined_drive.h"
#include "flexura/equipment/rig_equipment.h"
#include "flexura/equipment/visca_bus.h"
#include "flexura/equipment/watched_link.h"
#include "flexura/port/driven_arm.h"
#include "flexura/port/motion_ports.h"
#include "flexura/sim/arm_setup.h"

namespace flexura {

/// The user has asked the program to stop while the motors went to their first positions. They have been
/// halted.
class HomingCancelled : public std::runtime_error {
 public:
  HomingCancelled() : std::runtime_error("stopped while the motors went to their first positions") {}
};

/// The controllers of an arm, connected and with known motor positions.
class ArmEquipment {
 public:
  /// Connects to all controllers and determines the motor positions (RigEquipment::start). For this, homing
  /// and pretensioning move the motors. Returns when these motions are complete. `access` must outlive this
  /// object. Throws std::runtime_error with one clear line if a device cannot be used, and HomingCancelled.
  ArmEquipment(const RigEquipment& equipment, const ArmSetup& setup, DeviceAccess& access);
  /// Waits for the end of a motion in progress, unless an exception is being handled. Then stops the motors.
  ~ArmEquipment();
  ArmEquipment(const ArmEquipment&) = delete;
  ArmEquipment& operator=(const ArmEquipment&) = delete;

  /// Makes the ports. After this function, the drives may move. `time_shift`, s, is added to the times of
  /// readings.
  void start(double time_shift = 0);

  /// Returns the arm, after start().
  [[nodiscard]] DrivenArm& arm() { return *arm_; }
  /// Returns all motors, after start().
  [[nodiscard]] DrivePort& drive() { return *drive_; }
  /// Returns the single controllers, in the order of the axes; empty for drives on a CAN bus.
  [[nodiscard]] const std::vector<std::unique_ptr<GrblDrive>>& controllers() const { return grbl_; }
  /// Returns the drives on a CAN bus; null without such drives.
  [[nodiscard]] const Cia402Drive* bus() const { return can_ ? &*can_ : nullptr; }
  /// Returns the motor positions at which the arm has its initial shape, microsteps.
  [[nodiscard]] const std::vector<double>& rest() const { return rest_; }
  /// Sends the guard a sign of life.
  void beat();

 private:
  void guard_drive(double time_shift);
  // Throws unless the CAN drives are where the initial shape needs them.
  void check_declared(const std::vector<double>& positions) const;
  // Lets commanded motions end.
  void finish();
  void pull_in();
  void move_slowly(const std::vector<double>& targets);

  const RigEquipment equipment_;
  const ArmSetup setup_;
  DeviceAccess& access_;
  std::vector<double> rest_;
  std::unique_ptr<WatchedLink> link_;
  std::optional<Cia402Drive> can_;
  std::vector<std::unique_ptr<GrblDrive>> grbl_;
  std::optional<JoinedDrive> joined_;
  std::optional<GuardedDrive> guarded_;
  DrivePort* drive_ = nullptr;
  std::optional<DrivenArm> arm_;
};

/// The VISCA buses by their addresses. All heads of a chain share one bus.
using ViscaBuses = std::map<std::string, std::shared_ptr<ViscaBus>>;

/// Connects to the head of a camera, without moving it. Returns null if the camera has no head. `about`, if
/// not null, receives a description of the head, or "". `access` must outlive the head. Throws
/// std::runtime_error with one clear line if the head cannot be used.
[[nodiscard]] std::unique_ptr<HeadPort> open_head(const CameraEquipment& equipment, DeviceAccess& access,
                                                  ViscaBuses& buses, std::string* about = nullptr);

}  // namespace flexura
