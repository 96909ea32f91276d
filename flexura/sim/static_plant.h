#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/tendons.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/sim/bend_motion.h"
#include "flexura/sim/drive_motors.h"
#include "flexura/sim/plant.h"
#include "flexura/sim/pull_motion.h"

namespace flexura {

/// An arm that is an elastic rod: its tendons are pulled in, weight and loads pull at it, and it follows
/// without inertia from equilibrium to equilibrium (docs/mechanics.md). Of several it takes the one that its
/// way leads to, at steps of `step` s from time 0 on.
///
/// Behind a drive its spools pull the tendons in, from the pretension on; a motor that would have to turn
/// against more than its pull-out torque loses steps, a turn of its field at a time. Without a drive, what
/// commands call bends pulls each tendon in as far as arcs of these bends would, and pull() lets each differ
/// from that. std::runtime_error: the arm has no equilibrium.
class StaticPlant : public Plant {
 public:
  static constexpr double step = 0.02;

  /// The truth has a rod, with a tendon for each axis of its drive if it has one. std::invalid_argument: not
  /// so.
  explicit StaticPlant(const PlantSetup& setup);

  void command(double time, const Eigen::VectorXd& u, double duration) override;
  void halt(double time) override;
  /// Without a drive: behind one the motors take commands, and this does nothing.
  std::optional<ArmState> pull(double time, const std::vector<double>& displacements,
                               double duration) override;
  bool weigh(double time, bool on) override;
  [[nodiscard]] bool is_weighed(double time) const override;
  void advance(double time) override;
  [[nodiscard]] Backbone backbone(double time) const override { return backbone_of(equilibrium(time)); }
  [[nodiscard]] std::optional<ArmState> commanded(double time) const override;
  [[nodiscard]] std::vector<double> pulled(double time) const override;
  [[nodiscard]] std::string warning(double time) const override;
  [[nodiscard]] std::vector<double> tensions(double time) const override {
    return equilibrium(time).tensions;
  }
  [[nodiscard]] std::vector<double> lost_steps(double time) const override { return snapshot(time).lost; }

  /// How the rod stands in its frame, with its tendons' tensions. Times as backbone().
  [[nodiscard]] Equilibrium equilibrium(double time) const;

 private:
  struct Snapshot {
    long index = 0;  // Of steps.
    Equilibrium at;
    std::vector<double> lost;  // Microsteps of each axis, since the start.
    bool has_jumped = false;   // From where the one before was.
  };
  // The last one at or before a time.
  [[nodiscard]] const Snapshot& snapshot(double time) const;
  [[nodiscard]] std::vector<double> displacements(double time, const std::vector<double>& lost) const;
  [[nodiscard]] Equilibrium solved(double time, const Equilibrium& near,
                                   const std::vector<double>& lost) const;
  void forget();
  [[nodiscard]] bool is_jump(const Snapshot& from, const Snapshot& to) const;
  [[nodiscard]] Snapshot settled(long index, Snapshot from) const;
  [[nodiscard]] bool lose_steps(double time, const Equilibrium& at, std::vector<double>& lost) const;
  [[nodiscard]] Backbone backbone_of(const Equilibrium& at) const;

  Arm arm_;
  RodLoads loads_;
  double horizon_;
  // What moves it: one of the two.
  std::optional<DriveMotors> motors_;
  std::optional<Drive> drive_;
  std::vector<double> zero_;   // displacements where the motors are at 0, m, of an arm of arcs,
  std::vector<double> tight_;  // and what the pretension adds to them
  std::optional<BendMotion> bends_;
  std::optional<PullMotion> beside_;  // beside what the bends pull in

  struct Weighing {
    double time = 0;  // from which on
    bool on = true;
  };
  std::vector<Weighing> weighings_;  // by time, back to the horizon; before the first one: on
  std::vector<Snapshot> snapshots_;  // back to the horizon
  // Asked by several threads; what they get depends on none of what was solved before.
  mutable std::mutex mutex_;
  // What was asked last, for it is asked about in several ways; none after a change.
  struct Answer {
    double time = 0;
    Equilibrium at;
  };
  mutable std::optional<Answer> answer_;
  mutable RodStatics statics_;
  mutable RodChain fine_;                             // places many samples
  std::vector<std::vector<std::size_t>> fine_nodes_;  // of each section
};

/// The plant that the setup's truth is: a rod or a chain of arcs.
[[nodiscard]] std::unique_ptr<Plant> true_plant(const PlantSetup& setup);

}  // namespace flexura
