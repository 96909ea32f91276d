#include "flexura/servo/servo_law.h"

#include <array>
#include <utility>

namespace flexura {
namespace {

ImageLawGains gains_of(const ServoConfig& config) {
  ImageLawGains gains;
  gains.rate = config.rate;
  gains.damping = config.law == ServoLawKind::shape ? 0 : config.damping;
  return gains;
}

Eigen::VectorXd with_offset(Eigen::VectorXd values, const Eigen::VectorXd& offset) {
  if (offset.size() == values.size()) values += offset;
  return values;
}

bool is_same(const WantedShape& a, const WantedShape& b) {
  return a.state.bends == b.state.bends && a.state.stretches == b.state.stretches &&
         a.offset.size() == b.offset.size() && a.offset == b.offset;
}

}  // namespace

ServoLaw::ServoLaw(const Arm& arm, const ServoConfig& config, ServoFeatures& features)
    : config_(config),
      features_(features),
      law_(arm, gains_of(config)),
      response_(config.jacobian, law_.variables().size()) {}

Eigen::VectorXd ServoLaw::variables_of(const ArmState& state) const {
  Eigen::VectorXd x(law_.variables().size());
  const auto& parts = law_.variables().parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    x[parts[i].at] = state.bends[i].x();
    if (parts[i].is_spatial) x[parts[i].at + 1] = state.bends[i].y();
    if (parts[i].is_stretchable) x[parts[i].stretch_at()] = state.stretches[i];
  }
  return x;
}

void ServoLaw::go_along(const ArmState& wanted, const ArmState& next, ArmState& asked) const {
  if (response_.is_learned()) {
    const Eigen::VectorXd way = response_.drives_for(variables_of(next) - variables_of(wanted));
    asked = law_.variables().state(variables_of(asked) + way);
    return;
  }
  for (std::size_t i = 0; i < asked.bends.size(); ++i) {
    asked.bends[i] += next.bends[i] - wanted.bends[i];
    asked.stretches[i] += next.stretches[i] - wanted.stretches[i];
  }
}

ServoLaw::Wish ServoLaw::step(const Input& input) {
  const ArmState& estimate = input.sight.estimate.shape.state;
  const std::array<View, 2> views = {input.sight.seen[0].view, input.sight.seen[1].view};
  const auto seen = features_.measured(estimate, input.sight.seen);
  const auto error_from = [&](const WantedShape& wanted) -> std::optional<FeatureError> {
    const auto desired = seen ? features_.foreseen(wanted.state, views) : std::nullopt;
    if (!desired) return std::nullopt;
    return features_.error(*seen, with_offset(*desired, wanted.offset), estimate, views);
  };
  const auto is = error_from(input.wanted);
  if (!is) return {input.sent, 0, true};
  double potential = 0.5 * is->error.squaredNorm();
  if (!is_same(input.then, input.wanted)) {
    const auto was = error_from(input.then);
    if (!was) return {input.sent, 0, true};
    potential = 0.5 * was->error.squaredNorm();
  }
  Eigen::MatrixXd& J = J_;
  if (response_.is_learned()) {
    if (input.is_fresh) response_.learn(variables_of(input.said), variables_of(estimate));
    law_.by_variables(is->by_state, by_shape_);
    J.noalias() = by_shape_ * response_.matrix();
  } else {
    law_.by_variables(is->by_state, J);
  }
  Eigen::VectorXd error = is->error;
  // What was sent since the pictures were taken is on its way.
  if (config_.predicts) error += J * (law_.variables().pack(input.sent) - law_.variables().pack(input.said));
  ImageStep step;
  law_.step(input.sent, error, J, config_.step, work_, step);
  go_along(input.wanted.state, input.next, step.asked);
  return {std::move(step.asked), potential, step.is_singular};
}

}  // namespace flexura
