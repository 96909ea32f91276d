#include "flexura/servo/servo_law.h"

#include <array>
#include <utility>

#include "flexura/model/arm_way.h"

namespace flexura {
namespace {

ImageLawGains gains_of(const ServoConfig& config) {
  ImageLawGains gains;
  gains.rate = config.rate;
  gains.damping = config.law == ServoLawKind::shape ? 0 : config.damping;
  return gains;
}

bool is_same(const WantedShape& a, const WantedShape& b) {
  return a.state == b.state && a.offset.size() == b.offset.size() && a.offset == b.offset;
}

}  // namespace

ServoLaw::ServoLaw(const ArmModel& believed, const ServoConfig& config, ServoFeatures& features)
    : config_(config),
      features_(features),
      actuation_(believed.actuation()),
      law_(believed.driven(), gains_of(config)),
      response_(config.jacobian, law_.variables().size()) {}

void ServoLaw::pack(const ArmState& state, Eigen::VectorXd& x) const {
  const auto& parts = law_.variables().parts();
  x.resize(law_.variables().size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    x[parts[i].at] = state.bends[i].x();
    if (parts[i].is_spatial) x[parts[i].at + 1] = state.bends[i].y();
    if (parts[i].is_stretchable) x[parts[i].stretch_at()] = state.stretches[i];
  }
}

void ServoLaw::by_variables(const Eigen::MatrixXd& by_shape, const ArmState& command, Eigen::MatrixXd& J) {
  if (actuation_.is_identity()) {
    law_.by_variables(by_shape, J);
    return;
  }
  actuation_.by_command(by_shape, command, by_command_);
  law_.by_variables(by_command_, J);
}

bool ServoLaw::find_error(const Input& input, const WantedShape& wanted, FeatureError& result) {
  const ArmState& estimate = input.sight.estimate.shape.state;
  const std::array<View, 2> views = {input.sight.seen[0].view, input.sight.seen[1].view};
  if (!features_.foreseen(wanted.state, views, desired_)) return false;
  if (wanted.offset.size() == desired_.size()) desired_ += wanted.offset;
  interpolate(estimate, wanted.state, 0.5, halfway_);
  return features_.secant(seen_, desired_, {estimate, wanted.state, halfway_}, views, result);
}

void ServoLaw::go_along(const ArmState& wanted, const ArmState& next, ArmState& asked) {
  if (next == wanted) return;
  const ArmState from = actuation_.command(wanted), to = actuation_.command(next);
  if (response_.is_learned()) {
    pack(to, x_), pack(from, y_);
    y_ = response_.drives_for(x_ - y_);
    pack(asked, x_);
    law_.variables().state(x_ + y_, asked);
    return;
  }
  asked = plus(std::move(asked), minus(to, from));
}

ServoLaw::Wish ServoLaw::step(const Input& input) {
  const ArmState& estimate = input.sight.estimate.shape.state;
  if (input.is_fresh) features_.look(input.sight);
  if (!features_.measured(estimate, input.sight.seen, seen_) || !find_error(input, input.wanted, is_))
    return {input.sent, 0, true};
  double potential = 0.5 * is_.error.squaredNorm();
  if (!is_same(input.then, input.wanted)) {
    if (!find_error(input, input.then, was_)) return {input.sent, 0, true};
    potential = 0.5 * was_.error.squaredNorm();
  }
  if (response_.is_learned()) {
    if (input.is_fresh) {
      pack(input.said, x_), pack(actuation_.command(estimate), y_);
      response_.learn(x_, y_);
    }
    by_variables(is_.by_state, input.sent, by_shape_);
    J_.noalias() = by_shape_ * response_.matrix();
  } else {
    by_variables(is_.by_state, input.sent, J_);
  }
  // Commands since the exposure are still being carried out.
  if (config_.predict) {
    law_.variables().pack(input.sent, x_), law_.variables().pack(input.said, y_);
    x_ -= y_;
    is_.error.noalias() += J_ * x_;
  }
  law_.step(input.sent, is_.error, J_, config_.step, work_, step_);
  go_along(input.wanted.state, input.next, step_.asked);
  return {step_.asked, potential, step_.is_singular};
}

}  // namespace flexura
