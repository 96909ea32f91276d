#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/sim/thread_pool.h"
#include "python/bindings/rod.h"

namespace flexura::python {

/// The states of many equal arms, advanced on several threads. Each arm moves as if it were alone, so results
/// do not depend on the number of threads.
class DynamicsBatch {
 public:
  /// All arms start unloaded and at rest. Throws as RodDynamics.
  DynamicsBatch(const DescribedArm& arm, std::size_t count, std::size_t threads,
                const RodDynamicsConfig& config);

  [[nodiscard]] std::size_t count() const { return states_.size(); }
  [[nodiscard]] std::size_t tendons() const { return rod_.tendons(); }
  [[nodiscard]] Eigen::Index size() const { return workers_.front().chain().size(); }
  [[nodiscard]] const ArmsRod& rod() const { return rod_; }
  /// Returns the state of an arm.
  [[nodiscard]] const RodState& state(std::size_t arm) const { return states_[arm]; }
  /// Returns the state at the start.
  [[nodiscard]] const RodState& rest() const { return rest_; }
  /// Puts an arm into a state.
  void set(std::size_t arm, const RodState& state) { states_[arm] = state; }
  /// Puts an arm into its state at the start.
  void reset(std::size_t arm) { states_[arm] = rest_; }

  /// Calls work(dynamics, i) for each arm i, on the threads of the batch.
  template <class Work>
  void for_arms(const Work& work) {
    const std::size_t parts = pool_.threads();
    pool_.run(parts, [&](std::size_t part) {
      for (std::size_t i = count() * part / parts; i < count() * (part + 1) / parts; ++i)
        work(workers_[part], i);
    });
  }
  /// Advances all arms by `steps` steps of h seconds. An arm whose step does not converge keeps its state,
  /// and its entry of `converged` becomes false.
  void step(const TendonArray& inputs, double h, int steps, std::span<bool> converged);
  /// Writes the tips' poses X_WT as 4 x 4 matrices in rows.
  void tips(double* to);
  /// Writes the rates of the modes.
  void velocities(double* to);

 private:
  ArmsRod rod_;
  std::vector<RodDynamics> workers_;  // One for each thread.
  RodState rest_;
  std::vector<RodState> states_;
  ThreadPool pool_;
};

}  // namespace flexura::python
