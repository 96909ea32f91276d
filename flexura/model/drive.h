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

/// Displacements of all tendons of a drive. A tendon with a positive displacement is shorter than along the
/// straight, unstretched arm. The type distinguishes displacements from tensions.
struct TendonDisplacements {
  std::vector<double> pulled;  ///< Displacement of each tendon, m.
  /// Angle by which each tendon turns between the arm's base and its end, rad. This angle is only needed to
  /// compensate friction. Empty: friction is not compensated.
  std::vector<double> wraps = {};
};

/// A cable parallel to the backbone, from the arm's base to the end of one section, through all sections in
/// between.
struct Tendon {
  std::size_t section = 0;  ///< Index of the section at whose end the tendon ends; 0 at the base.
  double radius = 0.015;    ///< Distance from the backbone, m; > 0.
  double angle = 0;  ///< Angle around the backbone's z axis from its x axis, rad; equal in all sections.

  /// Returns the tendon's offset from the backbone in a cross-section: radius (cos angle, sin angle), m.
  [[nodiscard]] Eigen::Vector2d offset() const;
};

/// A stepper motor with its controller. Motor positions are counted in microsteps.
struct StepperMotor {
  std::int64_t phases = 3;       ///< Number of phases of the windings; at least 2.
  std::int64_t steps = 300;      ///< Full steps per revolution; a multiple of `phases`.
  std::int64_t microsteps = 10;  ///< Microsteps per full step.
  double max_speed = std::numeric_limits<double>::infinity();  ///< Largest speed of the motor, rad/s.
  /// Largest acceleration of the motor, rad/s^2.
  double max_acceleration = std::numeric_limits<double>::infinity();
  /// Largest rate of the controller, microsteps per second.
  double max_step_rate = std::numeric_limits<double>::infinity();
  /// Largest distance from position 0 in either direction, microsteps.
  double max_position = std::numeric_limits<double>::infinity();
  /// Pull-out torque as pairs of speed (rad/s) and torque (N m), in order of increasing speed. Outside the
  /// range of these speeds, the torque is constant. Default: unlimited torque.
  std::optional<std::vector<std::array<double, 2>>> pull_out = {};

  /// Returns the microsteps per turn.
  [[nodiscard]] double resolution() const { return static_cast<double>(steps * microsteps); }
  /// Returns the torque, N m, above which the motor loses steps at a speed, rad/s.
  [[nodiscard]] double pull_out_torque(double speed) const;
  /// Returns the number of microsteps between positions at which the rotor can lock to the windings' field.
  /// This number corresponds to one turn of the field, which is two full steps per phase.
  [[nodiscard]] double field_turn() const { return static_cast<double>(2 * phases * microsteps); }
};

/// Converts the motor's rotation to cable length. The cable is wound in one layer, so that the winding radius
/// is constant.
struct Spool {
  double radius = 0.01;  ///< Distance from the spool's axis to the middle of the cable, m; > 0.
  double gear = 1;       ///< Gear ratio: revolutions of the motor per revolution of the spool; > 0.
  double backlash = 0;   ///< Backlash between motor and spool, measured at the spool, rad; >= 0.
  /// Cable length that the spool winds after a reversal without effect on the arm. The cause is friction
  /// along a tendon that stretches. Metres per radian by which the tendon turns; >= 0. Default: 0.
  std::optional<double> friction_travel = {};
};

/// A motor with its spool, which pulls one tendon.
struct Axis {
  StepperMotor motor;
  Spool spool;
  bool reversed = false;  ///< Whether positive microsteps let the cable out instead of pulling it in.

  /// Returns the microsteps per metre of cable; positive.
  [[nodiscard]] double microsteps_a_metre() const;
  /// Returns the backlash in microsteps; >= 0, rarely an integer.
  [[nodiscard]] double backlash_steps() const;
  /// Returns the travel lost by friction after a reversal, in microsteps, for a tendon that turns by `wrap`,
  /// rad; >= 0.
  [[nodiscard]] double friction_steps(double wrap) const;
  /// Returns the motor torque, N m, that balances a tension, N; without losses.
  [[nodiscard]] double torque(double tension) const { return tension * spool.radius / spool.gear; }
  /// Returns the largest cable speed that motor and controller allow, m/s.
  [[nodiscard]] double max_cable_speed() const;
};

/// Drive of an arm: tendons, each pulled by the axis with the same index.
struct Drive {
  std::vector<Tendon> tendons;
  std::vector<Axis> axes;
  /// Number of equal pieces into which guide disks divide each section. Tendons are straight between disks.
  /// Default: tendons run in a continuous channel.
  std::optional<std::int64_t> disks;
  std::size_t axes_per_controller =
      4;  ///< Axes per controller; > 0. This number only affects the names of axes.
  /// Tension of each tendon of an elastic arm if all motors are at position 0 and the arm has no other loads,
  /// N; >= 0.
  double pretension = 0;

  /// Returns whether friction takes travel from any tendon (Spool::friction_travel).
  [[nodiscard]] bool loses_travel() const;
  /// Returns "CONTROLLER.AXIS", both counted from 1: the fifth axis is "2.1" if a controller has four.
  [[nodiscard]] std::string axis_name(std::size_t axis) const;
};

}  // namespace flexura
