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

/// Why an arm refuses a command, in words; "": it is a shape of this arm, and a duration.
[[nodiscard]] std::string command_problem(const Arm& arm, const ArmState& state, double duration);

/// The motors' positions, microsteps, at which a drive is believed to hold an arm in a shape, with the play
/// taken up for pulling in. std::invalid_argument: a shape or a drive of another arm.
[[nodiscard]] std::vector<std::int64_t> believed_positions(const Arm& arm, const Drive& drive,
                                                           const ArmState& state);

/// An arm behind a motion controller. What is believed of the arm and its drive makes targets of shapes, with
/// the play that it knows taken up, and shapes of what the controller says: a controller's driver needs to
/// know of neither.
///
/// A controller of motor positions counts 0 where the arm is straight and not stretched; one of displacements
/// says 0 there. What is behind the play is followed from reading to reading, unless the controller says it:
/// where a motor turns twice between two readings, the shape may be wrong by the play.
class DrivenArm : public ArmPort {
 public:
  /// `port` outlives this; the arm stands in `initial`, its motors at believed_positions().
  /// std::invalid_argument: a controller of tensions, for what they make of an arm is statics, which what is
  /// believed of it does not know; another number of axes than the drive's; a drive or a shape of another
  /// arm.
  DrivenArm(DrivePort& port, const Arm& arm, const Drive& drive, const ArmState& initial);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override { return port_.halt(); }
  Outcome<ArmReading> read() override;

  /// Sends each tendon to be pulled in so far, m, with the play that it knows taken up, whatever shape they
  /// make; `duration` as command() says. Refused: not one finite displacement a tendon, or one so far that a
  /// motor cannot count it.
  CommandOutcome pull(const std::vector<double>& displacements, double duration);

 private:
  [[nodiscard]] bool counts_motors() const { return port_.quantity() == DriveQuantity::motor_positions; }
  // Why the reading is none; "": it is one.
  [[nodiscard]] std::string problem_of(const DriveReading& reading) const;
  // Of the spools, microsteps, each in its motor's sense.
  [[nodiscard]] std::vector<double> carried(const DriveReading& reading);

  DrivePort& port_;
  Arm arm_;
  Drive drive_;
  MotorCommander commander_;
  std::vector<double> zero_;      // displacements where the motors are at 0, m
  std::vector<double> followed_;  // behind the play, microsteps pulled in; for a port that does not say it
};

/// The displacements where the motors are at 0 when those at `positions`, microsteps, make a shape, m: none
/// but for what is rounded. Errors as believed_positions().
[[nodiscard]] std::vector<double> displacements_at_zero(const Arm& arm, const Drive& drive,
                                                        const ArmState& state,
                                                        const std::vector<std::int64_t>& positions);

/// How far tendons are pulled in, m, when their spools stand at `carried`, microsteps, each in its motor's
/// sense, and at 0 leave the displacements `zero`, m. std::invalid_argument: other numbers of axes.
[[nodiscard]] TendonDisplacements displacements_carried(const Drive& drive, const std::vector<double>& zero,
                                                        const std::vector<double>& carried);

/// The shape that motors make when their spools stand at `carried`, microsteps, each in its motor's sense,
/// and at 0 leave the displacements `zero`, m. std::invalid_argument: other numbers of axes.
[[nodiscard]] ArmState shape_carried(const Arm& arm, const Drive& drive, const std::vector<double>& zero,
                                     const std::vector<double>& carried);

}  // namespace flexura
