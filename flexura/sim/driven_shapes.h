#pragma once

#include <cstdint>
#include <vector>

#include "flexura/kinematics/friction_play.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/sim/drive_motors.h"

namespace flexura {

/// The shapes over time of an arm of arcs that motors move. If friction takes travel of the tendons, the
/// shape depends on its past, which is followed in steps of `step` s from time 0. Answers do not depend on
/// earlier queries. Functions with `motors` expect the same motors, and they may be queried as far back as
/// these.
class DrivenShapes {
 public:
  static constexpr double step = 0.02;

  /// The arm has the shape `initial` at the motor positions `start`, microsteps, after its tendons were
  /// pulled in. `horizon`: as for the motors, s. Throws the exceptions of displacements_at_zero().
  DrivenShapes(const Arm& arm, const Drive& drive, const ArmState& initial,
               const std::vector<std::int64_t>& start, double horizon);

  /// Discards what is too old for the horizon. Call it before each command to the motors, with its time, s.
  void advance(double time, const DriveMotors& motors);
  /// Discards what is needed only before `time`, s.
  void forget_before(double time, const DriveMotors& motors);
  /// Returns the displacement of the cable at each spool, m. Future times are allowed.
  [[nodiscard]] std::vector<double> spools(double time, const DriveMotors& motors) const;
  /// Returns the shape. Future times are allowed.
  [[nodiscard]] ArmState at(double time, const DriveMotors& motors) const;

 private:
  Arm arm_;
  Drive drive_;
  std::vector<double> zero_;  // Displacements of the cables at motor position 0, m.
  bool loses_travel_;
  FrictionPlay play_;  // At the time index_ * step.
  long index_ = 0;
  double horizon_, latest_ = 0;  // Time of the last command, s.
};

}  // namespace flexura
