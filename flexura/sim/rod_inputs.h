#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/surroundings.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/sim/bend_motion.h"
#include "flexura/sim/drive_motors.h"
#include "flexura/sim/driven_shapes.h"
#include "flexura/sim/plant.h"
#include "flexura/sim/pull_motion.h"

namespace flexura {

/// The inputs of a rod over time: its motors or commanded bends, and its weight and loads, which can be
/// switched off. The inputs are functions of time and of the commands up to this time.
///
/// With a drive, the spools pull the tendons in, starting from the pretension. A motor whose load exceeds its
/// pull-out torque loses the steps of one turn of its field at a time. Without a drive, tendon displacements
/// are the displacements of arcs with the commanded bends, plus the displacements of pull(). Commanded
/// stretches are factors on the sections' lengths.
class RodInputs {
 public:
  /// Throws std::invalid_argument if the truth has no rod, if it has a drive but not one tendon per axis, or
  /// if there is no equilibrium under the pretension.
  explicit RodInputs(const PlantSetup& setup);

  /// Implements Plant::command().
  void command(double time, const Eigen::VectorXd& u, double duration);
  /// Implements Plant::halt(). The following functions, up to pulled(), implement the functions of Plant that
  /// have equal names.
  void halt(double time);
  /// Pulls the tendons individually.
  std::optional<ArmState> pull(double time, const std::vector<double>& displacements, double duration);
  /// Switches weight and loads on or off.
  bool weigh(double time, bool on);
  /// Returns whether weight and loads are on.
  [[nodiscard]] bool is_weighed(double time) const;
  /// Sets the push on the arm. Throws std::invalid_argument as Plant::push().
  void push(double time, const std::optional<PlantPush>& push);
  /// Returns the push on the arm at a time; std::nullopt without a push.
  [[nodiscard]] std::optional<PlantPush> pushed(double time) const;
  /// Returns the push as a spring on the rod, in the frame of the rod's base.
  [[nodiscard]] std::optional<PointSpring> spring(double time) const;
  /// Returns whether the push changes at a time in (start, end], s.
  [[nodiscard]] bool is_pushed_anew(double start, double end) const;
  /// Returns the commanded bends and stretches.
  [[nodiscard]] std::optional<ArmState> commanded(double time) const;
  /// Returns by how much each tendon is pulled in, m.
  [[nodiscard]] std::vector<double> pulled(double time) const;
  /// Discards records before `time`, s. Afterwards no time before `time` may be queried.
  void forget_before(double time);

  [[nodiscard]] const Rod& rod() const { return rod_; }
  /// Returns a vector of zeros, one per axis, for lost microsteps; empty without a drive.
  [[nodiscard]] std::vector<double> nothing_lost() const;
  /// Returns by how much each tendon is pulled in relative to the rod at rest, m. The result includes the
  /// pretension, and the `lost` microsteps of each motor are subtracted.
  [[nodiscard]] std::vector<double> displacements(double time, const std::vector<double>& lost) const;
  /// Returns the sections' unloaded lengths, as factors on their nominal lengths.
  [[nodiscard]] std::vector<double> rest_stretches(double time) const;
  /// Returns whether commands can change the lengths of sections.
  [[nodiscard]] bool can_stretch() const;
  /// Returns the times after `start` and before `end`, s, at which tendons break or the weight is switched.
  [[nodiscard]] std::vector<double> events(double start, double end) const;
  /// Returns the loads on the rod other than the tendons.
  [[nodiscard]] const RodLoads& loads(double time) const;
  /// Returns whether the weight is switched at a time in (start, end], s.
  [[nodiscard]] bool is_weighed_anew(double start, double end) const;
  /// Returns whether any motor can lose steps.
  [[nodiscard]] bool may_lose_steps() const;
  /// Returns, for each axis, whether the motor is overloaded: its load under these tensions, N, exceeds
  /// `part` times the pull-out torque at its current rate. Empty without a drive.
  [[nodiscard]] std::vector<char> overloaded(double time, const std::vector<double>& tensions,
                                             double part = 1) const;
  /// Returns the number of microsteps per turn of the magnetic field in an axis's motor.
  [[nodiscard]] double field_turn(std::size_t axis) const;
  /// Adds a turn of the field to the lost microsteps of each motor that is overloaded under these tensions,
  /// N. Returns whether any motor was overloaded.
  [[nodiscard]] bool lose_steps(double time, const std::vector<double>& tensions,
                                std::vector<double>& lost) const;

 private:
  Arm arm_;
  Rod rod_;
  RodLoads loads_;
  // One of these moves the rod: motors_ or bends_.
  std::optional<DriveMotors> motors_;
  std::optional<Drive> drive_;
  std::optional<DrivenShapes> shapes_;  // Of an arm of arcs that the motors move.
  std::vector<double> tight_;           // Displacements that the pretension adds, m.
  std::optional<BendMotion> bends_;
  std::optional<PullMotion> beside_;  // Displacements in addition to those of the bends.
  std::vector<TendonBreak> breaks_;

  struct Weighing {
    double time = 0;  // Start, s.
    bool on = true;
  };
  std::vector<Weighing> weighings_;  // Ordered by time; before the first entry the weight is on.

  struct Pushing {
    double time = 0;  // Start, s.
    std::optional<PlantPush> push;
    std::optional<PointSpring> spring;
  };
  [[nodiscard]] PointSpring spring_of(const PlantPush& push) const;
  [[nodiscard]] const Pushing* pushing(double time) const;
  std::vector<Pushing> pushings_;  // Ordered by time; before the first entry there is no push.
};

}  // namespace flexura
