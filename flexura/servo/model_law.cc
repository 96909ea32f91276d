#include "flexura/servo/model_law.h"

#include <array>
#include <cstddef>

namespace flexura {
namespace {

// Errors within the horizon decay a little slower than at the predictive law's own rate. A critically damped
// error decays faster at first, and delays make fast modal laws swing.
constexpr double predictive_rate = 1.5, modal_rate = 0.75;

}  // namespace

ModelLaw::ModelLaw(const ArmModel& model, const ServoConfig& config)
    : model_(model), step_(config.step), horizon_(PredictiveLawConfig().horizon), limits_(model, config) {
  if (config.law == ServoLawKind::predictive) {
    predictive_.emplace(model_.driven(), model_.shaped(),
                        PredictiveLawConfig{.step = step_, .rate = predictive_rate * config.rate});
  } else {
    const ModalLawKind kind =
        config.law == ServoLawKind::computed_torque ? ModalLawKind::computed_torque : ModalLawKind::potential;
    modal_.emplace(model_.driven(),
                   ModalLawConfig{.kind = kind, .step = step_, .rate = modal_rate * config.rate});
  }
}

ArmState ModelLaw::command(const Times& times, const ArmState& sent, const ArmState& before,
                           const ShapeObserver& observer, const ServoGoals& goals) {
  PredictiveState state{.sent = sent,
                        .rate = sent,
                        .rest = observer.expected(model_.actuation().shape(sent)),
                        .desired = goals.at(times.since_start).state};
  for (std::size_t i = 0; i < sent.bends.size(); ++i) {
    state.rate.bends[i] = (sent.bends[i] - before.bends[i]) / step_;
    state.rate.stretches[i] = (sent.stretches[i] - before.stretches[i]) / step_;
  }
  if (times.since_start < goals.last())
    for (int k = 1; k <= horizon_; ++k)
      state.desired_later.push_back(goals.at(times.since_start + k * step_).state);
  state.modes = observer.swing().modes();
  state.swing = observer.swing().after(observer.path_until(times.now, state.modes));
  state.frequency_factors = observer.swing().frequency_factors();
  Eigen::MatrixXd by_command;
  model_.actuation().slopes(sent, by_command);
  if (modal_) return modal_->step(state, by_command);
  const ServoObservation& observed = *observer.last();
  state.limits = limits_.find(sent, state.rest, by_command, {observed.seen[0].view, observed.seen[1].view});
  const ArmState command = predictive_->step(state, by_command);
  const std::optional<std::size_t> active = predictive_->active_limit();
  limit_ = active ? state.limits[*active].name : "";
  return command;
}

}  // namespace flexura
