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
#include "flexura/sim/energy_audit.h"
#include "flexura/sim/rod_plant.h"
#include "flexura/sim/rotors.h"
#include "flexura/sim/simulation_error.h"

namespace flexura {

/// A plant whose arm is an elastic rod with inertia (docs/mechanics.md, "In time"). Tendons, weight and loads
/// act on the arm, which can oscillate. The plant's ArmRod defines contact with obstacles and the drag of a
/// fluid.
///
/// The arm starts at rest, and its motion is computed in steps of ArmRod::time_step from time 0. Each step
/// uses the commands that are valid during the step. The state at a time between two steps is computed by a
/// shorter step. Once the end of the step has been computed, backbone() interpolates the shape instead; the
/// difference is about the error of a step. Steps are divided when a payload is picked up or dropped, a
/// tendon breaks, or the weight is switched. Motors lose steps as described for RotorState. Throws
/// SimulationError if a step does not converge even when divided.
class DynamicPlant : public RodPlant {
 public:
  /// Throws the exceptions of RodInputs and RodDynamics, and SimulationError if there is no initial
  /// equilibrium.
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
    long index = 0;  // Step number.
    RodState state;
    RotorState rotors;
    std::vector<char> carried;  // For each payload, whether it is carried.
    int divided = 0;            // Number of steps up to here that did not converge at once.
    EnergyAudit audit = {};
  };
  // Returns the last snapshot at or before a time.
  [[nodiscard]] const Snapshot& snapshot(double time) const;
  [[nodiscard]] double time_of(long index) const { return static_cast<double>(index) * step_; }
  // These functions require that mutex_ is held.
  void go_on(Snapshot& at, double from, double to) const;
  void turn(Snapshot& at, double from, double to) const;
  void move(Snapshot& at, double from, double h) const;
  void step(Snapshot& at, double from, double h) const;
  void hand_over(Snapshot& at, double time) const;
  void audit(Snapshot& at, double from, double to) const;
  [[nodiscard]] bool is_driven(const Snapshot& at, double from, double to) const;
  void set_lengths(double time) const;
  [[nodiscard]] std::vector<double> events(double from, double to) const;
  void carry(const std::vector<char>& desired) const;
  void grab(const std::optional<RodPlace>& place) const;
  void surround() const;
  [[nodiscard]] std::optional<RodPlace> grabbed_at(double time) const;
  [[nodiscard]] std::vector<char> carried_at(double time) const;
  [[nodiscard]] std::vector<PlantContact> found(const std::vector<ContactForce>& contacts) const;
  // Returns the motion of the rod and the carried payloads at a time.
  [[nodiscard]] Snapshot at(double time) const;
  // Returns the modes' amplitudes at a time by interpolation within a step. Empty if the step's end is not
  // known yet, or if an event within the step changes the motion.
  [[nodiscard]] std::optional<Eigen::VectorXd> shape_between(double time) const;

  ArmRod rod_;
  Pose X_WB_;
  std::vector<std::string> names_;  // Names of the obstacles.
  std::vector<double> bases_;       // Arc lengths of the sections' bases, m.
  double step_, horizon_;
  bool may_lose_steps_ = false, can_stretch_ = false;
  std::vector<Snapshot> snapshots_;  // Back to the horizon.
  // Queried by several threads. Answers do not depend on earlier queries.
  mutable std::mutex mutex_;
  struct Answer {
    double time = 0;
    Snapshot at;
    std::optional<std::vector<PlantContact>> contacts = {};  // Filled on the first query.
  };
  // The last answers, cached because several cameras query the same times; empty after a change.
  static constexpr std::size_t most_answers = 8;
  mutable std::vector<Answer> answers_;
  mutable std::size_t next_answer_ = 0;                // Index of the answer to replace next.
  [[nodiscard]] Answer* answer_at(double time) const;  // Null if none; requires mutex_.
  mutable RodDynamics dynamics_;
  mutable std::vector<char> carried_;  // Payloads that dynamics_ carries.
  // Built on the nodes of dynamics_, which include the pushed point.
  mutable std::optional<RodContact> contact_;
  mutable std::optional<RodDrag> drag_;
  mutable std::optional<RodSpring> spring_;
  mutable std::optional<Surroundings> surroundings_;
  mutable std::optional<RodPlace> grabbed_;
};

}  // namespace flexura
