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
#include "flexura/sim/plant.h"
#include "flexura/sim/pull_motion.h"

namespace flexura {

/// What moves a rod and what pulls at it, over time: its motors, or the bends that are commanded; its weight
/// and loads, which may be switched off. A function of time and of the commands up to then.
///
/// Behind a drive its spools pull the tendons in, from the pretension on; a motor that would have to turn
/// against more than its pull-out torque loses steps, a turn of its field at a time. Without a drive, what
/// commands call bends pulls each tendon in as far as arcs of these bends would, pull() lets each differ from
/// that, and what commands call stretches are factors on the sections' own lengths.
class RodInputs {
 public:
  /// The truth has a rod, with a tendon for each axis of its drive if it has one. std::invalid_argument: not
  /// so, or no rest under the pretension.
  explicit RodInputs(const PlantSetup& setup);

  /// As Plant's.
  void command(double time, const Eigen::VectorXd& u, double duration);
  /// As Plant's, as all up to pulled().
  void halt(double time);
  /// Tendons one by one.
  std::optional<ArmState> pull(double time, const std::vector<double>& displacements, double duration);
  /// Weight and loads, on or off.
  bool weigh(double time, bool on);
  /// Whether they are on.
  [[nodiscard]] bool is_weighed(double time) const;
  /// What pushes the arm. std::invalid_argument: as Plant::push.
  void push(double time, const std::optional<PlantPush>& push);
  /// Returns what pushes the arm at a time; std::nullopt if nothing does.
  [[nodiscard]] std::optional<PlantPush> pushed(double time) const;
  /// The same as a spring of the rod, in the frame of its base.
  [[nodiscard]] std::optional<PointSpring> spring(double time) const;
  /// Whether that changed after `start` and up to `end`, s.
  [[nodiscard]] bool is_pushed_anew(double start, double end) const;
  /// The bends and stretches that are commanded.
  [[nodiscard]] std::optional<ArmState> commanded(double time) const;
  /// How far each tendon is pulled in, m.
  [[nodiscard]] std::vector<double> pulled(double time) const;
  /// What was so before `time` is asked for no more.
  void forget_before(double time);

  [[nodiscard]] const Rod& rod() const { return rod_; }
  /// What its axes have lost when nothing has moved yet, microsteps; none without a drive.
  [[nodiscard]] std::vector<double> nothing_lost() const;
  /// How far each tendon is pulled in, m, from the rod at rest on: with the pretension, and less what its
  /// motor has lost, microsteps.
  [[nodiscard]] std::vector<double> displacements(double time, const std::vector<double>& lost) const;
  /// How long its sections are by themselves: factors on their lengths.
  [[nodiscard]] std::vector<double> rest_stretches(double time) const;
  /// Whether commands may drive sections longer or shorter.
  [[nodiscard]] bool can_stretch() const;
  /// When tendons break and the weight is switched, after `start` and before `end`, s.
  [[nodiscard]] std::vector<double> events(double start, double end) const;
  /// What pulls at it beside its tendons.
  [[nodiscard]] const RodLoads& loads(double time) const;
  /// Whether the weight was switched after `start` and up to `end`, s.
  [[nodiscard]] bool is_weighed_anew(double start, double end) const;
  /// Whether any motor may lose steps at all.
  [[nodiscard]] bool may_lose_steps() const;
  /// Of each axis, whether its motor would have to turn against more than this part of its pull-out torque,
  /// as fast as it turns then, under these tensions, N. Empty: without a drive.
  [[nodiscard]] std::vector<char> overloaded(double time, const std::vector<double>& tensions,
                                             double part = 1) const;
  /// Microsteps of a turn of an axis's field.
  [[nodiscard]] double field_turn(std::size_t axis) const;
  /// Adds a turn of the field to what each motor has lost that would have to turn against more than it can,
  /// under these tensions, N. Whether any has.
  [[nodiscard]] bool lose_steps(double time, const std::vector<double>& tensions,
                                std::vector<double>& lost) const;

 private:
  Arm arm_;
  Rod rod_;
  RodLoads loads_;
  // What moves it: one of the two.
  std::optional<DriveMotors> motors_;
  std::optional<Drive> drive_;
  std::vector<double> zero_;   // displacements where the motors are at 0, m, of an arm of arcs,
  std::vector<double> tight_;  // and what the pretension adds to them
  std::optional<BendMotion> bends_;
  std::optional<PullMotion> beside_;  // beside what the bends pull in
  std::vector<TendonBreak> breaks_;

  struct Weighing {
    double time = 0;  // from which on
    bool on = true;
  };
  std::vector<Weighing> weighings_;  // by time; before the first one: on

  struct Pushing {
    double time = 0;  // from which on
    std::optional<PlantPush> push;
    std::optional<PointSpring> spring;
  };
  [[nodiscard]] PointSpring spring_of(const PlantPush& push) const;
  [[nodiscard]] const Pushing* pushing(double time) const;
  std::vector<Pushing> pushings_;  // by time; before the first one: none
};

}  // namespace flexura
