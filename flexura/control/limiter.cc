#include "flexura/control/limiter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include "flexura/control/limiter_paths.h"
#include "flexura/kinematics/motion.h"
#include "flexura/kinematics/motors.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/model/arm_difference.h"
#include "flexura/safety/contact_watch.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

// Returns the time over which a change of rate between two commands counts as acceleration, s. In a list with
// rows shorter than a step, it is one row. If rows are longer, two rows contain several changes, at most with
// the weights 1, and 1 - k step/row on both sides.
double turning_time(double step, double row) {
  const double ratio = row / step, others = std::max(0.0, std::ceil(ratio) - 1);
  return row / (1 + 2 * others - others * (others + 1) / ratio);
}

}  // namespace

CommandLimiter::CommandLimiter(ArmModel arm, LimiterConfig config, const ArmState& start)
    : model_(std::move(arm)),
      arm_(model_.driven()),
      config_(std::move(config)),
      variables_(arm_),
      limits_(limit_watches(arm_)),
      sent_(start) {
  std::vector<ContactWatch> contacts;
  if (config_.looks_ahead) {
    contacts.emplace_back(model_.shaped());
    for (const Obstacle& obstacle : config_.obstacles) contacts.emplace_back(model_.shaped(), obstacle);
  }
  contacts_ = std::make_shared<const std::vector<ContactWatch>>(std::move(contacts));
  if (!(config_.step > 0) || !std::isfinite(config_.step))
    throw std::invalid_argument("a limiter's step must be finite and above 0");
  if (!(config_.list_step >= 0) || !std::isfinite(config_.list_step))
    throw std::invalid_argument("a command list's step must be finite and not below 0");
  row_ = config_.list_step > 0 ? config_.list_step : config_.step;
  turning_time_ = turning_time(config_.step, row_);
  if (!fits(arm_, start) || !is_possible(start))
    throw std::invalid_argument("a limiter must start in a finite state of its arm");
  last_step_.motors = motors_at(start);
  last_step_.rates = last_step_.swing = Eigen::VectorXd::Zero(last_step_.motors.size());
  std::string broken = breach({start});
  if (broken.empty() && config_.looks_ahead) broken = contact({start});
  if (!broken.empty()) throw std::invalid_argument("a limiter must start within the limits: " + broken);
}

LimitedCommand CommandLimiter::next(const ArmState& asked) {
  asked_ = asked;
  if (!fault_) {
    if (!fits(arm_, asked))
      fault("the law's command does not fit this arm");
    else if (!is_possible(asked))
      fault("the law's command is not finite, or gives a section a length that is not above 0");
  }
  if (fault_) return brake();
  std::string reason;
  const ArmState desired = within_limits(asked, reason);
  Plan whole = plan(desired, config_.looks_ahead);
  if (whole.is_allowed) return send(std::move(whole), reason, reason.empty());
  if (reason.empty()) reason = whole.reason;
  // The nearest command within the limits. Those of contact are slow, and count only where there is one.
  ArmState target = desired;
  bool keeps_clear = whole.touches;
  for (int i = 0; i < 2; ++i) {
    const std::optional<ArmState> near = nearest(desired, keeps_clear);
    if (!near) break;
    target = *near;
    Plan trial = plan(target, config_.looks_ahead);
    if (trial.is_allowed) return send(std::move(trial), reason, false);
    if (!trial.touches || keeps_clear) break;
    reason = trial.reason;
    keeps_clear = true;
  }
  // From braking, which is allowed, as far towards this command as allowed.
  const ArmState braked = path_to_rest_.empty() ? sent_ : path_to_rest_.front();
  double low = 0, high = 1;
  Plan best;
  const ArmDifference way = minus(target, braked);
  for (int i = 0; i < 40 && high - low > 1e-3 * high; ++i) {
    const double middle = 0.5 * (low + high);
    Plan trial = plan(plus(braked, way, middle), false);
    (trial.is_allowed ? low : high) = middle;
    if (trial.is_allowed) best = std::move(trial);
  }
  // Contact is checked last, and from farther back, because it is slower.
  for (int i = 0; config_.looks_ahead && best.is_allowed && i < 4; ++i) {
    const std::string touched = contact(best.way);
    if (touched.empty()) break;
    reason = touched;
    low *= i < 3 ? 0.5 : 0;
    best = low > 0 ? plan(plus(braked, way, low), false) : Plan{};
  }
  if (best.is_allowed) return send(std::move(best), reason, false);
  LimitedCommand command = brake();
  command.reason = reason;
  return command;
}

// For a way w in one step, the speed is w/step and the remaining distance w/(rate step). A share k of it has
// k w/step = sqrt(2 a w/(rate step)).
ArmState CommandLimiter::within_braking(const ArmState& asked, double rate) const {
  if (!config_.drive || !fits(arm_, asked) || !is_possible(asked)) return asked;
  const Eigen::VectorXd way = motors_at(asked) - last_step_.motors;
  double square = 1;
  for (std::size_t i = 0; i < config_.drive->axes.size(); ++i) {
    const double braking =
        0.5 * motor_acceleration(config_.drive->axes[i].motor) * turning_time_ / config_.step;
    const double far = std::abs(way[static_cast<Eigen::Index>(i)]);
    if (far > 0) square = std::min(square, 2 * braking * config_.step / (rate * far));
  }
  return square < 1 ? plus(sent_, minus(asked, sent_), std::sqrt(square)) : asked;
}

LimitedCommand CommandLimiter::brake() {
  Plan plan;
  plan.way = path_to_rest_.empty() ? std::vector<ArmState>{sent_} : path_to_rest_;
  plan.is_allowed = true;
  return send(std::move(plan), fault_ ? fault_->reason : std::string(), false);
}

void CommandLimiter::fault(const std::string& reason) {
  if (fault_) return;
  fault_ = record(reason);
}

void CommandLimiter::reset() {
  if (!is_at_rest()) throw std::logic_error("a limiter can continue only when the arm is at rest");
  fault_.reset();
}

LimitedCommand CommandLimiter::send(Plan plan, std::string reason, bool is_untouched) {
  LimitedCommand command;
  command.is_at_rest = plan.way.size() == 1 && plan.way.front() == sent_;
  if (config_.drive) last_step_ = motor_step(sent_, last_step_.motors, plan.way.front());
  sent_ = plan.way.front();
  path_to_rest_.assign(plan.way.begin() + 1, plan.way.end());
  ++steps_;
  command.state = sent_;
  command.is_untouched = is_untouched;
  command.reason = std::move(reason);
  return command;
}

ArmState CommandLimiter::within_limits(const ArmState& asked, std::string& reason) const {
  ArmState state = asked;
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const Section& section = arm_.sections[i];
    const auto say = [&](const char* what) {
      if (reason.empty()) reason = fmt::format("section {}: {} at its limit", i + 1, what);
    };
    const double stretch =
        std::clamp(state.stretches[i], section.stretch_limits[0], section.stretch_limits[1]);
    if (stretch != state.stretches[i]) say("stretch");
    state.stretches[i] = stretch;
    constexpr double short_of_folding = 1 - 1e-6;
    const double radius = std::max(section.radius[0], section.radius[1]);
    const double fold = short_of_folding * section.length * stretch / radius;
    const double limit = std::min(section.max_bend, fold), bend = state.bends[i].norm();
    if (bend > limit) state.bends[i] *= limit / bend, say(limit == fold ? "folding" : "bend");
    if (arm_.kind == ArmKind::planar && state.bends[i].y() != 0)
      state.bends[i].y() = 0, say("bend out of the arm's plane");
  }
  return state;
}

// Plans the way from `next` to rest at evenly decreasing rates, in as few steps as the motors allow.
CommandLimiter::Plan CommandLimiter::plan(const ArmState& next, bool looks_ahead) const {
  Plan plan;
  const int fewest = braking_steps(next);
  for (const int count : {fewest, 2 * fewest + 1}) {
    if (count > config_.most_braking) {
      if (plan.reason.empty()) plan.reason = "the motors' acceleration";
      return plan;
    }
    plan.way = path_of(sent_, next, count);
    plan.reason = breach(plan.way);
    if (plan.reason.empty() || fewest == 1) break;
  }
  if (plan.reason.empty() && looks_ahead) {
    plan.reason = contact(plan.way);
    plan.touches = !plan.reason.empty();
  }
  plan.is_allowed = plan.reason.empty();
  return plan;
}

int CommandLimiter::braking_steps(const ArmState& next) const {
  if (!config_.drive) return 1;
  const Eigen::VectorXd rates = (motors_at(next) - last_step_.motors) / config_.step;
  double steps = 1;
  for (std::size_t i = 0; i < config_.drive->axes.size(); ++i) {
    const StepperMotor& motor = config_.drive->axes[i].motor;
    const double change = motor_acceleration(motor) * turning_time_;  // In microsteps/s per step.
    steps = std::max(steps, std::ceil(std::abs(rates[static_cast<Eigen::Index>(i)]) / change * (1 + 1e-9)));
  }
  return static_cast<int>(std::min(steps, 1e6));
}

std::string CommandLimiter::breach(const std::vector<ArmState>& way) const {
  const ArmState* before = &sent_;
  for (const ArmState& state : way) {
    if (!is_possible(state)) return "a section's length is not above 0";
    for (const LimitWatch& watch : limits_)
      if (watch.sign * watch.value(state) > watch.threshold())
        return fmt::format("section {}: {}", watch.section + 1, name_of(watch.hazard));
    for (std::size_t i = 0; i < state.bends.size(); ++i) {
      const double rate = (state.bends[i] - before->bends[i]).norm() / config_.step;
      if (rate > arm_.sections[i].max_bend_rate * (1 + 0.5 * limit_tolerance))
        return fmt::format("section {}: bend rate", i + 1);
      const double stretching = std::abs(state.stretches[i] - before->stretches[i]) / config_.step;
      if (stretching > arm_.sections[i].max_stretch_rate * (1 + 0.5 * limit_tolerance))
        return fmt::format("section {}: stretch rate", i + 1);
    }
    before = &state;
  }
  return config_.drive ? breach_of_motors(way) : std::string();
}

// A step's rates are constant if tendons are linear in the bends. Otherwise (guide disks) they vary by
// `swing` to both sides of their mean.
CommandLimiter::MotorStep CommandLimiter::motor_step(const ArmState& from, const Eigen::VectorXd& motors_from,
                                                     const ArmState& to) const {
  MotorStep step;
  step.motors = motors_at(to);
  step.rates = (step.motors - motors_from) / config_.step;
  step.swing = Eigen::VectorXd::Zero(step.rates.size());
  if (config_.drive->disks)
    step.swing =
        (step.motors + motors_from - 2 * motors_at(plus(from, minus(to, from), 0.5))) / (0.5 * config_.step);
  return step;
}

std::string CommandLimiter::breach_of_motors(const std::vector<ArmState>& way) const {
  const Drive& drive = *config_.drive;
  constexpr double slack = 1 + 0.5 * limit_tolerance;
  const ArmState* from = &sent_;
  MotorStep before = last_step_;
  // One additional step at the end: the arm is at rest.
  for (std::size_t k = 0; k <= way.size(); ++k) {
    const ArmState& to = way[std::min(k, way.size() - 1)];
    const MotorStep now = motor_step(*from, before.motors, to);
    std::vector<double> wraps;
    if (drive.loses_travel()) wraps = tendon_wraps(arm_, drive, to);
    for (std::size_t i = 0; i < drive.axes.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const StepperMotor& motor = drive.axes[i].motor;
      const auto say = [&](const char* what) {
        return fmt::format("motor {}: {}", drive.axis_name(i), what);
      };
      // A stop is a hard limit: the list has to stay within it with backlash, friction and rounding. If the
      // arm starts nearer to it than that, it must not get nearer.
      const double friction = wraps.empty() ? 0 : drive.axes[i].friction_steps(wraps[i]) / 2,
                   beyond = drive.axes[i].backlash_steps() + friction + 0.5;
      const double already = std::min(std::abs(before.motors[at]), motor.max_position);
      if (!(std::abs(now.motors[at]) <= std::max(motor.max_position - beyond, already)))
        return say("position");
      const double swing = std::abs(now.swing[at]), swing_before = std::abs(before.swing[at]);
      if (!(std::abs(now.rates[at]) + swing <= motor_rate(motor) * slack)) return say("speed");
      const double within = 2 * std::max(swing, swing_before) * std::min(1.0, row_ / config_.step);
      const double change = std::abs(now.rates[at] - before.rates[at]) + swing + swing_before + within;
      if (!(change <= motor_acceleration(motor) * turning_time_ * slack)) return say("acceleration");
    }
    before = now, from = &to;
  }
  return {};
}

std::string CommandLimiter::contact(const std::vector<ArmState>& way) const {
  const Actuation& actuation = model_.actuation();
  std::vector<double> times{0};
  std::vector<ArmState> states{sent_};
  for (const ArmState& state : way) {
    times.push_back(times.back() + config_.step);
    states.push_back(state);
  }
  if (actuation.is_linear()) {
    const MotionPtr motion = keyframe_motion(times, states, Interpolation::linear);
    const SafetyReport report =
        check_motions(model_, config_.obstacles, sent_, {{motion, 0, "look-ahead"}}, config_.step);
    return report.violations.empty() ? std::string() : report.violations.front().what();
  }
  // Steps are short: an elastic arm's shape is nearly linear in the command within a step.
  for (ArmState& state : states) {
    state = actuation.shape(state);
    if (!is_possible(state)) return "the arm has no equilibrium";
  }
  const MotionPtr motion = keyframe_motion(times, states, Interpolation::linear);
  const SafetyReport report = check_motions(model_.shaped(), config_.obstacles, states.front(),
                                            {{motion, 0, "look-ahead"}}, config_.step);
  for (Violation violation : report.violations) {
    if (!is_of_shape(violation.hazard)) continue;
    if (violation.section) violation.section = actuation.section_of()[*violation.section];
    if (violation.other_section) violation.other_section = actuation.section_of()[*violation.other_section];
    return violation.what();
  }
  return {};
}

Eigen::VectorXd CommandLimiter::motors_at(const ArmState& state) const {
  if (!config_.drive) return {};
  const std::vector<double> positions =
      motor_positions(*config_.drive, tendon_displacements(arm_, *config_.drive, state));
  return Eigen::Map<const Eigen::VectorXd>(positions.data(), static_cast<Eigen::Index>(positions.size()));
}

}  // namespace flexura
