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

/// Displacement of each tendon of a drive, m: positive is shorter than on the straight, unstretched arm. A
/// separate type, to distinguish it from tensions.
struct TendonDisplacements {
  std::vector<double> pulled;  ///< m, one per tendon.
};

/// A cable parallel to the backbone from the arm's base to the end of one section, through all sections below
/// it.
struct Tendon {
  std::size_t section = 0;  ///< Section at whose end it ends, 0 at the base.
  double radius = 0.015;    ///< Distance from the backbone, m; > 0.
  double angle = 0;         ///< Angle around the backbone's z from its x, rad; the same in every section.

  /// Returns its offset in a cross-section: radius (cos angle, sin angle), m.
  [[nodiscard]] Eigen::Vector2d offset() const;
};

/// A stepper motor with its controller. Its positions are counted in microsteps.
struct StepperMotor {
  std::int64_t phases = 3;       ///< Number of its windings' phases; at least 2.
  std::int64_t steps = 300;      ///< Full steps per turn; a multiple of the phases.
  std::int64_t microsteps = 10;  ///< Per full step.
  double max_speed = std::numeric_limits<double>::infinity();         ///< Of the motor, rad/s.
  double max_acceleration = std::numeric_limits<double>::infinity();  ///< Of the motor, rad/s^2.
  double max_step_rate = std::numeric_limits<double>::infinity();     ///< Microsteps per second.
  double max_position = std::numeric_limits<double>::infinity();      ///< Microsteps to either side of 0.
  /// Pull-out torque: pairs of speed, rad/s, increasing, and torque, N m. Constant beyond its ends. Default:
  /// unlimited torque.
  std::optional<std::vector<std::array<double, 2>>> pull_out = {};

  /// Returns the microsteps per turn.
  [[nodiscard]] double resolution() const { return static_cast<double>(steps * microsteps); }
  /// Returns the torque above which it loses steps at a speed, rad/s, in N m.
  [[nodiscard]] double pull_out_torque(double speed) const;
  /// Returns the microsteps between positions where the rotor may lock to the windings' field. This is one
  /// turn of the field, two full steps per phase.
  [[nodiscard]] double field_turn() const { return static_cast<double>(2 * phases * microsteps); }
};

/// Converts a motor's turns to cable. The cable is wound side by side: the radius does not grow.
struct Spool {
  double radius = 0.01;  ///< To the middle of the cable, m; > 0.
  double gear = 1;       ///< Turns of the motor per turn of the spool; > 0.
  double backlash = 0;   ///< Backlash between motor and spool, rad of the spool; >= 0.
};

/// A motor with its spool. Each pulls one tendon.
struct Axis {
  StepperMotor motor;
  Spool spool;
  bool reversed = false;  ///< Positive microsteps pay out cable.

  /// Returns the microsteps per metre of cable; positive.
  [[nodiscard]] double microsteps_a_metre() const;
  /// Returns the backlash in microsteps; >= 0, rarely an integer.
  [[nodiscard]] double backlash_steps() const;
  /// Returns the motor's torque for a tension, N m; without losses.
  [[nodiscard]] double torque(double tension) const { return tension * spool.radius / spool.gear; }
  /// Returns the highest cable speed of the motor and its controller, m/s.
  [[nodiscard]] double max_cable_speed() const;
};

/// Drive of an arm: tendons, and for each the axis with the same index.
struct Drive {
  std::vector<Tendon> tendons;
  std::vector<Axis> axes;
  /// Number of equal pieces per section between guide disks, through which the tendons run straight;
  /// otherwise they run in a continuous channel.
  std::optional<std::int64_t> disks;
  std::size_t axes_per_controller = 4;  ///< > 0; only for names.
  /// Tension of each tendon with the motors at 0 and without other loads, N; >= 0. For arms that are elastic
  /// rods.
  double pretension = 0;

  /// Returns "CONTROLLER.AXIS", both counted from 1: the fifth axis is "2.1" if a controller has four.
  [[nodiscard]] std::string axis_name(std::size_t axis) const;
};

}  // namespace flexura
