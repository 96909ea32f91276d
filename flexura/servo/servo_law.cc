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
    : config_(config), features_(features), law_(arm, gains_of(config)) {}

void ServoLaw::learn(const Eigen::VectorXd& seen, const ArmState& said, const Eigen::MatrixXd& model) {
  // Smaller motions show less in the features than the pictures' noise: they are waited for until they add
  // up.
  constexpr double least = 0.03;  // rad
  constexpr double share = 0.5, forgetting = 0.97, doubt = 300;
  const Eigen::VectorXd x = law_.variables().pack(said);
  if (!x_before_) {
    if (config_.jacobian == ServoJacobian::broyden) learned_ = BroydenEstimate(model, share, least);
    if (config_.jacobian == ServoJacobian::recursive)
      learned_ = RecursiveEstimate(model, forgetting, doubt, least);
  } else {
    const Eigen::VectorXd dx = x - *x_before_, df = seen - *f_before_;
    if (dx.norm() < least) return;
    if (auto* broyden = std::get_if<BroydenEstimate>(&learned_)) (void)broyden->learn(dx, df);
    if (auto* recursive = std::get_if<RecursiveEstimate>(&learned_)) (void)recursive->learn(dx, df);
  }
  x_before_ = x, f_before_ = seen;
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
  law_.by_variables(is->by_state, J);
  if (config_.jacobian != ServoJacobian::model) {
    if (input.is_fresh) learn(*seen, input.said, J);
    if (const auto* broyden = std::get_if<BroydenEstimate>(&learned_)) J = broyden->jacobian();
    if (const auto* recursive = std::get_if<RecursiveEstimate>(&learned_)) J = recursive->jacobian();
  }
  Eigen::VectorXd error = is->error;
  // What was sent since the pictures were taken is on its way.
  if (config_.predicts) error += J * (law_.variables().pack(input.sent) - law_.variables().pack(input.said));
  ImageStep step;
  law_.step(input.sent, error, J, config_.step, work_, step);
  for (std::size_t i = 0; i < step.asked.bends.size(); ++i) {
    step.asked.bends[i] += input.next.bends[i] - input.wanted.state.bends[i];
    step.asked.stretches[i] += input.next.stretches[i] - input.wanted.state.stretches[i];
  }
  return {std::move(step.asked), potential, step.is_singular};
}

}  // namespace flexura
