#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/motors.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/port/drive_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// Returns the reason why an arm refuses a command, or "" if it is a shape of this arm and a valid duration.
[[nodiscard]] std::string command_problem(const Arm& arm, const ArmState& state, double duration);

/// Returns the motor positions, microsteps, at which a drive holds an arm in a shape by the model, with the
/// backlash compensated for pulling in. Throws std::invalid_argument if the shape or the drive is of another
/// arm.
[[nodiscard]] std::vector<std::int64_t> nominal_positions(const Arm& arm, const Drive& drive,
                                                          const ArmState& state);

/// An arm behind a motion controller. The model of the arm and its drive converts shapes to targets, with
/// backlash compensation, and the controller's readings to shapes. So a controller's driver needs neither
/// model.
///
/// A controller of motor positions is at 0 where the arm is straight and unstretched; one of displacements
/// reports 0 there. The positions behind the backlash are followed from reading to reading, unless the
/// controller reports them. If a motor reverses twice between two readings, the shape may be wrong by the
/// backlash.
class DrivenArm : public ArmPort {
 public:
  /// The arm is in `initial`, its motors at nominal_positions(). `port` must outlive this object. Throws
  /// std::invalid_argument if the controller takes tensions, has another number of axes than the drive, or
  /// the drive or shape is of another arm. Tensions need statics to make a shape, which the model does not
  /// have.
  DrivenArm(DrivePort& port, const Arm& arm, const Drive& drive, const ArmState& initial);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override { return port_.halt(); }
  Outcome<ArmReading> read() override;

  /// Pulls in each tendon by this displacement, m, with backlash compensation, whatever shape results.
  /// `duration` is as for command(). Refused: other than one finite displacement per tendon, or one beyond
  /// the motor's count.
  CommandOutcome pull(const std::vector<double>& displacements, double duration);

 private:
  [[nodiscard]] bool counts_motors() const { return port_.quantity() == DriveQuantity::motor_positions; }
  // Returns the reason why the reading is invalid, or "".
  [[nodiscard]] std::string problem_of(const DriveReading& reading) const;
  // Returns the positions of the spools, microsteps, each in its motor's direction.
  [[nodiscard]] std::vector<double> carried(const DriveReading& reading);

  DrivePort& port_;
  Arm arm_;
  Drive drive_;
  MotorCommander commander_;
  std::vector<double> zero_;      // Displacements where the motors are at 0, m.
  std::vector<double> followed_;  // Behind the backlash, microsteps; for a port without carried values.
};

/// Returns the displacements, m, where the motors are at 0 if the motors at `positions`, microsteps, make
/// this shape. They are 0 up to rounding. Throws like nominal_positions().
[[nodiscard]] std::vector<double> displacements_at_zero(const Arm& arm, const Drive& drive,
                                                        const ArmState& state,
                                                        const std::vector<std::int64_t>& positions);

/// Returns the displacements of the tendons, m, with their spools at `carried`, microsteps, each in its
/// motor's direction. At 0 the displacements are `zero`, m. Throws std::invalid_argument if the numbers of
/// axes differ.
[[nodiscard]] TendonDisplacements displacements_carried(const Drive& drive, const std::vector<double>& zero,
                                                        const std::vector<double>& carried);

/// Returns the shape with the spools at `carried`, microsteps, each in its motor's direction. At 0 the
/// displacements are `zero`, m. Throws std::invalid_argument if the numbers of axes differ.
[[nodiscard]] ArmState shape_carried(const Arm& arm, const Drive& drive, const std::vector<double>& zero,
                                     const std::vector<double>& carried);

}  // namespace flexura
