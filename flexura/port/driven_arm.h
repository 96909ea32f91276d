#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/friction_play.h"
#include "flexura/kinematics/motors.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/port/drive_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// Returns the reason why an arm refuses a command; "" if `state` fits the arm and `duration`, s, is valid.
[[nodiscard]] std::string command_problem(const Arm& arm, const ArmState& state, double duration);

/// Returns the motor positions, microsteps, for which the model predicts the shape `state`, with backlash
/// and friction compensated for pulling in. Throws std::invalid_argument if the shape or the drive does not
/// fit the arm.
[[nodiscard]] std::vector<std::int64_t> nominal_positions(const Arm& arm, const Drive& drive,
                                                          const ArmState& state);

/// Port of an arm that a motion controller drives. Converts shapes to targets of the controller, with
/// compensation of backlash and friction, and the controller's readings to shapes, using models of arm and
/// drive. Hence the software of the controller needs no models.
///
/// Motor positions or displacements of the controller are 0 for the straight, unstretched arm. If the
/// controller does not report load positions, this class tracks the backlash from reading to reading. The
/// class always tracks the travel lost by friction in this way. If a motor then reverses twice between two
/// readings, the shape may have an error of up to the backlash or the lost travel.
class DrivenArm : public ArmPort {
 public:
  /// Assumes that the arm has the shape `initial` and the motors are at nominal_positions(). `port` must
  /// outlive this object. Throws std::invalid_argument if the numbers of axes of controller and drive differ,
  /// or if drive or shape do not fit the arm. Also throws std::invalid_argument for a controller of tensions,
  /// because the shape for given tensions needs a static model, which this class does not use.
  DrivenArm(DrivePort& port, const Arm& arm, const Drive& drive, const ArmState& initial);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override { return port_.halt(); }
  Outcome<ArmReading> read() override;

  /// Pulls in each tendon by a displacement, m, with compensation of backlash and friction, regardless of
  /// the resulting shape. `duration`, s: see command(). The command is refused unless there is one
  /// finite displacement per tendon that is not too large in microsteps.
  CommandOutcome pull(const std::vector<double>& displacements, double duration);

 private:
  [[nodiscard]] bool counts_motors() const { return port_.quantity() == DriveQuantity::motor_positions; }
  CommandOutcome send(const TendonDisplacements& desired, double duration);
  // Returns the reason why a reading is invalid, otherwise "".
  [[nodiscard]] std::string problem_of(const DriveReading& reading) const;
  // Returns the positions of the spools, microsteps, positive in each motor's own direction.
  [[nodiscard]] std::vector<double> carried(const DriveReading& reading);

  DrivePort& port_;
  Arm arm_;
  Drive drive_;
  MotorCommander commander_;
  std::vector<double> zero_;  // Displacements at motor positions 0, m.
  std::vector<double>
      followed_;  // Positions behind the backlash, microsteps, if the port does not report them.
  FrictionPlay play_;
};

/// Returns the cable displacements at the spools at motor positions 0, m. At the motor positions `positions`,
/// microsteps, the arm has the shape `state`, and its tendons were pulled in last. For nominal positions,
/// these displacements are 0 up to rounding. Throws the exceptions of nominal_positions().
[[nodiscard]] std::vector<double> displacements_at_zero(const Arm& arm, const Drive& drive,
                                                        const ArmState& state,
                                                        const std::vector<std::int64_t>& positions);

/// Returns the cable displacements, m, for spool positions `carried`, microsteps, positive in each motor's
/// own direction. Without friction these are the displacements of the tendons. `zero`: displacements at spool
/// positions 0, m. Throws std::invalid_argument if the numbers of axes differ.
[[nodiscard]] TendonDisplacements displacements_carried(const Drive& drive, const std::vector<double>& zero,
                                                        const std::vector<double>& carried);

/// Returns the shape for spool positions `carried`, microsteps, positive in each motor's own direction.
/// Neglects the travel that friction absorbs. `zero`: displacements at spool positions 0, m. Throws
/// std::invalid_argument if the numbers of axes differ.
[[nodiscard]] ArmState shape_carried(const Arm& arm, const Drive& drive, const std::vector<double>& zero,
                                     const std::vector<double>& carried);

}  // namespace flexura
