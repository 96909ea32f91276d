#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/rod_spring.h"
#include "flexura/mechanics/statics.h"
#include "flexura/mechanics/surroundings.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/rod_plant.h"
#include "flexura/sim/rotors.h"
#include "flexura/sim/simulation_error.h"

namespace flexura {

/// An arm that is an elastic rod in motion (docs/mechanics.md, "In time"): its tendons are pulled in, weight
/// and loads pull at it, and it swings. It begins at rest, and is computed in steps of ArmRod::time_step from
/// time 0 on, with commands as they are in each step; between two steps by a shorter one. So what it answers
/// depends on time and commands alone. It touches obstacles and moves in a fluid as its ArmRod says. Where it
/// picks a payload up or drops it, a tendon breaks or the weight is switched inside a step, the step is cut
/// there. Motors lose steps as RotorState says. SimulationError: a step does not converge, however short.
class DynamicPlant : public RodPlant {
 public:
  /// Errors as RodInputs and RodDynamics. std::invalid_argument: the arm comes to no rest to begin with.
  explicit DynamicPlant(const PlantSetup& setup);
  ~DynamicPlant() override;

  void advance(double time) override;
  [[nodiscard]] Backbone backbone(double time) const override;
  [[nodiscard]] std::vector<double> tensions(double time) const override;
  [[nodiscard]] std::vector<double> lost_steps(double time) const override {
    return snapshot(time).rotors.lost;
  }
  [[nodiscard]] std::optional<RodEnergy> energy(double time) const override;
  [[nodiscard]] std::vector<PlantContact> contacts(double time) const override;
  [[nodiscard]] std::string warning(double time) const override;

 protected:
  void forget() override;

 private:
  struct Snapshot {
    long index = 0;  // Of steps.
    RodState state;
    RotorState rotors;
    std::vector<char> carried;  // Which of the payloads.
  };
  // The last one at or before a time.
  [[nodiscard]] const Snapshot& snapshot(double time) const;
  [[nodiscard]] double time_of(long index) const { return static_cast<double>(index) * step_; }
  // With mutex_ held.
  void go_on(Snapshot& at, double from, double to) const;
  void turn(Snapshot& at, double from, double to) const;
  void move(Snapshot& at, double from, double h) const;
  void hand_over(Snapshot& at, double time) const;
  void set_lengths(double time) const;
  [[nodiscard]] std::vector<double> events(double from, double to) const;
  void carry(const std::vector<char>& desired) const;
  void grab(const std::optional<RodPlace>& place) const;
  void surround() const;
  [[nodiscard]] std::optional<RodPlace> grabbed_at(double time) const;
  [[nodiscard]] std::vector<char> carried_at(double time) const;
  [[nodiscard]] std::vector<PlantContact> found(const std::vector<ContactForce>& contacts) const;
  // How the rod moves at a time, and what it carries.
  [[nodiscard]] Snapshot at(double time) const;

  ArmRod rod_;
  Pose X_WB_;
  std::vector<std::string> names_;  // of the obstacles
  std::vector<double> bases_;       // of the sections, m
  double step_, horizon_;
  bool may_lose_steps_ = false, can_stretch_ = false;
  std::vector<Snapshot> snapshots_;  // back to the horizon
  // Asked by several threads; what they get depends on none of what was computed before.
  mutable std::mutex mutex_;
  struct Answer {
    double time = 0;
    Snapshot at;
    std::optional<std::vector<PlantContact>> contacts = {};  // once somebody asked
  };
  mutable std::optional<Answer> answer_;  // the last one; none after a change
  mutable RodDynamics dynamics_;
  mutable std::vector<char> carried_;  // by dynamics_
  // Of the nodes of dynamics_; the point that is pushed is one.
  mutable std::optional<RodContact> contact_;
  mutable std::optional<RodDrag> drag_;
  mutable std::optional<RodSpring> spring_;
  mutable std::optional<Surroundings> surroundings_;
  mutable std::optional<RodPlace> grabbed_;
};

}  // namespace flexura
