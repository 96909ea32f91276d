#include "flexura/servo/servo_law.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "flexura/model/arm_difference.h"

namespace flexura {
namespace {

ImageLawGains gains_of(const ServoConfig& config) {
  ImageLawGains gains;
  gains.rate = config.rate;
  gains.damping = config.law == ServoLawKind::shape ? 0 : config.damping;
  return gains;
}

bool is_same(const TargetShape& a, const TargetShape& b) {
  return a.state == b.state && a.offset.size() == b.offset.size() && a.offset == b.offset;
}

// Whether bends, rad, and stretches differ by rounding alone.
bool is_equal_but_for_rounding(const ArmState& a, const ArmState& b) {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < a.bends.size(); ++i)
    if ((a.bends[i] - b.bends[i]).norm() > rounding || std::abs(a.stretches[i] - b.stretches[i]) > rounding)
      return false;
  return true;
}

}  // namespace

ServoLaw::ServoLaw(const ArmModel& nominal, const ServoConfig& config, ServoFeatures& features)
    : config_(config),
      features_(features),
      actuation_(nominal.actuation()),
      law_(nominal.driven(), gains_of(config)),
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

// The law controls the equilibrium of the arm, so its features are those without the swing.
bool ServoLaw::find_features(const ServoObservation& observed) {
  const ArmState& estimate = observed.estimate.shape.state;
  if (!features_.measured(estimate, observed.seen, seen_)) return false;
  if (observed.rest == estimate) return true;
  const std::array<View, 2> views = {observed.seen[0].view, observed.seen[1].view};
  Eigen::VectorXd swung, rest;
  if (!features_.predict(estimate, views, swung) || !features_.predict(observed.rest, views, rest))
    return false;
  seen_ += rest - swung;
  return true;
}

bool ServoLaw::find_error(const Input& input, const TargetShape& desired, FeatureError& result) {
  const ArmState& estimate = input.observed.rest;
  const std::array<View, 2> views = {input.observed.seen[0].view, input.observed.seen[1].view};
  if (!features_.predict(desired.state, views, desired_)) return false;
  if (desired.offset.size() == desired_.size()) desired_ += desired.offset;
  interpolate(estimate, desired.state, 0.5, halfway_);
  return features_.secant(seen_, desired_, {estimate, desired.state, halfway_}, views, result);
}

void ServoLaw::go_along(const ArmState& desired, const ArmState& next, ArmState& asked) {
  if (next == desired) return;
  // The next shape of a moving target equals the target at the next step, except for rounding of the time.
  const bool is_known = next_ && is_equal_but_for_rounding(*next_, desired);
  const ArmState from = is_known ? next_command_ : actuation_.command(desired), to = actuation_.command(next);
  next_ = next, next_command_ = to;
  if (response_.is_learned()) {
    pack(to, x_), pack(from, y_);
    y_ = response_.drives_for(x_ - y_);
    pack(asked, x_);
    law_.variables().state(x_ + y_, asked);
    return;
  }
  asked = plus(std::move(asked), minus(to, from));
}

ServoLaw::Output ServoLaw::step(const Input& input) {
  const ArmState& estimate = input.observed.rest;
  if (input.is_fresh) features_.look(input.observed);
  if (!find_features(input.observed) || !find_error(input, input.desired, is_)) return {input.sent, 0, true};
  double potential = 0.5 * is_.error.squaredNorm();
  if (!is_same(input.then, input.desired)) {
    if (!find_error(input, input.then, was_)) return {input.sent, 0, true};
    potential = 0.5 * was_.error.squaredNorm();
  }
  if (response_.is_learned()) {
    if (input.is_fresh) {
      pack(input.measured, x_), pack(actuation_.command(estimate), y_);
      response_.learn(x_, y_);
    }
    by_variables(is_.by_state, input.sent, by_shape_);
    J_.noalias() = by_shape_ * response_.matrix();
  } else {
    by_variables(is_.by_state, input.sent, J_);
  }
  // Commands since the exposure are still being carried out.
  if (config_.predict) {
    law_.variables().pack(input.sent, x_), law_.variables().pack(input.measured, y_);
    x_ -= y_;
    is_.error.noalias() += J_ * x_;
  }
  law_.step(input.sent, is_.error, J_, config_.step, work_, step_);
  go_along(input.desired.state, input.next, step_.asked);
  return {step_.asked, potential, step_.is_singular};
}

}  // namespace flexura
