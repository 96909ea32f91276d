#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "flexura/mechanics/statics.h"
#include "flexura/sim/rod_plant.h"
#include "flexura/sim/simulation_error.h"

namespace flexura {

/// A plant whose arm is an elastic rod without inertia (docs/mechanics.md). The arm is always in equilibrium
/// under tendons, weight and loads. If there are several equilibria, the arm is in the equilibrium that it
/// reaches along its path. The path is computed in steps of `step` s from time 0. Throws SimulationError if
/// the arm has no equilibrium.
class StaticPlant : public RodPlant {
 public:
  static constexpr double step = 0.02;

  /// Throws the exceptions of RodInputs.
  explicit StaticPlant(const PlantSetup& setup);

  void advance(double time) override;
  [[nodiscard]] Backbone backbone(double time) const override {
    return tube().backbone(equilibrium(time).q, inputs().rest_stretches(time));
  }
  [[nodiscard]] std::string warning(double time) const override;
  [[nodiscard]] std::vector<double> tensions(double time) const override {
    return equilibrium(time).tensions;
  }
  [[nodiscard]] std::vector<double> lost_steps(double time) const override { return snapshot(time).lost; }

  /// Returns the equilibrium of the rod in the frame of its base, with the tendon tensions. Times are as for
  /// backbone().
  [[nodiscard]] Equilibrium equilibrium(double time) const;

 protected:
  void forget() override;

 private:
  struct Snapshot {
    long index = 0;  // Step number.
    Equilibrium at;
    std::vector<double> lost;  // Microsteps lost by each axis since the start.
    bool has_jumped = false;   // Relative to the previous snapshot.
  };
  // Returns the last snapshot at or before a time.
  [[nodiscard]] const Snapshot& snapshot(double time) const;
  [[nodiscard]] Equilibrium solved(double time, const Equilibrium& near,
                                   const std::vector<double>& lost) const;
  [[nodiscard]] bool is_jump(const Snapshot& from, const Snapshot& to) const;
  [[nodiscard]] Snapshot settled(long index, Snapshot from) const;

  double horizon_;
  std::vector<Snapshot> snapshots_;  // Back to the horizon.
  // Queried by several threads. Answers do not depend on earlier queries.
  mutable std::mutex mutex_;
  // The last answer, cached because several functions query the same time; empty after a change.
  struct Answer {
    double time = 0;
    Equilibrium at;
  };
  mutable std::optional<Answer> answer_;
  // Makes the pushed point a node of statics_.
  void grab(const std::optional<RodPlace>& place) const;
  mutable std::optional<RodPlace> grabbed_;
  mutable RodStatics statics_;
};

}  // namespace flexura
