#include "python/bindings/dynamics_batch.h"

#include "python/bindings/locked.h"

namespace flexura::python {

DynamicsBatch::DynamicsBatch(const DescribedArm& arm, std::size_t count, std::size_t threads,
                             const RodDynamicsConfig& config)
    : rod_(arm), pool_(threads > 0 ? threads : 1) {
  require_some(count, threads);
  workers_.reserve(threads);
  for (std::size_t i = 0; i < threads; ++i) workers_.emplace_back(rod_.rod, config);
  rest_ = workers_.front().rest();
  states_.assign(count, rest_);
}

void DynamicsBatch::step(const TendonArray& inputs, double h, int steps, std::span<bool> converged) {
  for_arms([&](RodDynamics& dynamics, std::size_t i) {
    thread_local TendonInput input;
    input.tensions.clear();
    input.displacements.clear();
    inputs.read(i, input);
    converged[i] = true;
    for (int k = 0; k < steps && converged[i]; ++k)
      converged[i] = dynamics.step(states_[i], input, rod_.loads, h).converged();
  });
}

void DynamicsBatch::tips(double* to) {
  for_arms([&](RodDynamics& dynamics, std::size_t i) {
    write_pose(rod_.X_WB * dynamics.tip(states_[i]), to + 16 * i);
  });
}

void DynamicsBatch::velocities(double* to) {
  const Eigen::Index modes = size();
  for_arms([&](RodDynamics& dynamics, std::size_t i) {
    Eigen::Map<Eigen::VectorXd>(to + i * static_cast<std::size_t>(modes), modes) =
        dynamics.velocity(states_[i]);
  });
}

}  // namespace flexura::python
