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

/// An arm that is an elastic rod: its tendons are pulled in, weight and loads pull at it, and it follows
/// without inertia from equilibrium to equilibrium (docs/mechanics.md). Of several it takes the one that its
/// way leads to, at steps of `step` s from time 0 on. SimulationError: the arm has no equilibrium.
class StaticPlant : public RodPlant {
 public:
  static constexpr double step = 0.02;

  /// Errors as RodInputs.
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

  /// How the rod stands in its frame, with its tendons' tensions. Times as backbone().
  [[nodiscard]] Equilibrium equilibrium(double time) const;

 protected:
  void forget() override;

 private:
  struct Snapshot {
    long index = 0;  // Of steps.
    Equilibrium at;
    std::vector<double> lost;  // Microsteps of each axis, since the start.
    bool has_jumped = false;   // From where the one before was.
  };
  // The last one at or before a time.
  [[nodiscard]] const Snapshot& snapshot(double time) const;
  [[nodiscard]] Equilibrium solved(double time, const Equilibrium& near,
                                   const std::vector<double>& lost) const;
  [[nodiscard]] bool is_jump(const Snapshot& from, const Snapshot& to) const;
  [[nodiscard]] Snapshot settled(long index, Snapshot from) const;

  double horizon_;
  std::vector<Snapshot> snapshots_;  // back to the horizon
  // Asked by several threads; what they get depends on none of what was solved before.
  mutable std::mutex mutex_;
  // What was asked last, for it is asked about in several ways; none after a change.
  struct Answer {
    double time = 0;
    Equilibrium at;
  };
  mutable std::optional<Answer> answer_;
  // With the point that is pushed among its nodes.
  void grab(const std::optional<RodPlace>& place) const;
  mutable std::optional<RodPlace> grabbed_;
  mutable RodStatics statics_;
};

}  // namespace flexura
