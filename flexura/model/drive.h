#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// How far each tendon of a drive is pulled in, m: positive is shorter than on the straight, unstretched arm.
/// A type of its own, so that no tension passes for one.
struct TendonDisplacements {
  std::vector<double> pulled;  ///< m, one a tendon.
};

/// A cable that runs parallel to the backbone from the arm's base to the end of one section, through all the
/// sections below it.
struct Tendon {
  std::size_t section = 0;  ///< The one at whose end it ends, 0 at the base.
  double radius = 0.015;    ///< Distance from the backbone, m; > 0.
  double angle = 0;         ///< Around the backbone's z from its x, rad; the same in every section.

  /// Where it runs in a cross-section: radius (cos angle, sin angle), m.
  [[nodiscard]] Eigen::Vector2d offset() const;
};

/// A stepper motor as its controller drives it. Its positions are counted in microsteps.
struct StepperMotor {
  std::int64_t phases = 3;       ///< Of its windings; from 2 on.
  std::int64_t steps = 300;      ///< Full steps a turn; a multiple of the phases.
  std::int64_t microsteps = 10;  ///< A full step.
  double max_speed = std::numeric_limits<double>::infinity();         ///< Of the motor, rad/s.
  double max_acceleration = std::numeric_limits<double>::infinity();  ///< Of the motor, rad/s^2.
  double max_step_rate = std::numeric_limits<double>::infinity();     ///< Microsteps a second.
  double max_position = std::numeric_limits<double>::infinity();      ///< Microsteps to either side of 0.
  /// Pull-out torque: pairs of speed, rad/s and rising from the first on, and torque, N m. Beyond its ends as
  /// there. None: it pulls whatever it must.
  std::optional<std::vector<std::array<double, 2>>> pull_out = {};

  /// Microsteps a turn.
  [[nodiscard]] double resolution() const { return static_cast<double>(steps * microsteps); }
  /// The torque under which it loses its steps at a speed, rad/s, N m.
  [[nodiscard]] double pull_out_torque(double speed) const;
  /// Microsteps from one place where the rotor may lock to the windings' field to the next: one turn of the
  /// field, two full steps for each phase.
  [[nodiscard]] double field_turn() const { return static_cast<double>(2 * phases * microsteps); }
};

/// What turns a motor's turns into cable. The cable lies side by side: the radius does not grow.
struct Spool {
  double radius = 0.01;  ///< To the middle of the cable, m; > 0.
  double gear = 1;       ///< Turns of the motor for one of the spool; > 0.
  double backlash = 0;   ///< Play between motor and spool, rad of the spool; >= 0.
};

/// A motor with its spool. Each pulls one tendon.
struct Axis {
  StepperMotor motor;
  Spool spool;
  bool reversed = false;  ///< Positive microsteps let cable out.

  /// Microsteps for a metre of cable; positive.
  [[nodiscard]] double microsteps_a_metre() const;
  /// The play in microsteps; >= 0, seldom whole.
  [[nodiscard]] double play() const;
  /// By which the motor must turn against a tension, N m; without losses.
  [[nodiscard]] double torque(double tension) const { return tension * spool.radius / spool.gear; }
  /// The fastest that the motor and its controller wind cable, m/s.
  [[nodiscard]] double max_cable_speed() const;
};

/// What moves an arm: tendons, and for each the axis of the same index that pulls it.
struct Drive {
  std::vector<Tendon> tendons;
  std::vector<Axis> axes;
  /// The tendons run straight between guide disks that cut each section into this many equal pieces;
  /// otherwise in a continuous channel.
  std::optional<std::int64_t> disks;
  std::size_t axes_per_controller = 4;  ///< > 0; for names alone.
  /// Of each tendon where the motors are at 0 and nothing else pulls, N; >= 0. Of arms that are elastic rods.
  double pretension = 0;

  /// "CONTROLLER.AXIS", both counted from 1: the fifth axis is "2.1" where a controller has four.
  [[nodiscard]] std::string axis_name(std::size_t axis) const;
};

}  // namespace flexura
