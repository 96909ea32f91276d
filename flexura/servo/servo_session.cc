#include "flexura/servo/servo_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>

#include "flexura/camera/camera.h"
#include "flexura/model/arm_difference.h"
#include "flexura/port/camera_moves.h"
#include "flexura/servo/disturbance_watch.h"
#include "flexura/servo/model_law.h"
#include "flexura/servo/picture_meter.h"
#include "flexura/servo/rig_reader.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_goals.h"
#include "flexura/servo/servo_judge.h"
#include "flexura/servo/servo_law.h"
#include "flexura/servo/shape_observer.h"
#include "flexura/servo/view_keeper.h"

namespace flexura {
namespace {

void check(const RigPorts& ports, const RigModel& nominal, const ServoConfig& config) {
  check_servo(config);
  if (ports.cameras.size() != nominal.cameras.size() || config.cameras[0] == config.cameras[1] ||
      config.cameras[0] >= nominal.cameras.size() || config.cameras[1] >= nominal.cameras.size())
    throw std::invalid_argument("a servo needs the ports of two cameras of the model");
}

class Session {
 public:
  Session(const RigPorts& ports, const RigModel& nominal, const ServoConfig& config,
          ServoSessionWatcher& watcher)
      : model_(nominal),
        nominal_arm_(nominal.arm_model()),
        config_(config),
        watcher_(watcher),
        rig_(ports, nominal, config.cameras,
             {.span = longest_delay,
              .together = 0.6 * (1 / slower_frame_rate(nominal.cameras, config.cameras)),
              .silent = config.hold_after}),
        meter_(nominal, config),
        observer_(rig_, nominal, config),
        features_(servo_features(config, nominal)),
        law_(nominal_arm_, config, *features_),
        keeper_(nominal, config.cameras) {
    // A learned Jacobian is used when the model is wrong. The watch would take a swing that the model lacks
    // for a disturbance.
    const bool is_known =
        config.jacobian == ServoJacobian::model &&
        !nominal_arm_.actuation().swing(ArmState::straight(nominal_arm_.driven().sections.size()), 1).empty();
    if (config.disturbance || is_known)
      watch_.emplace(nominal_arm_, DisturbanceConfig{.limit = config.disturbance.value_or(0.05)});
    if (predicts_motion(config.law)) model_law_.emplace(nominal_arm_, config);
  }

  ServoResult run() {
    result_.start = rig_.now();
    if (auto error = begin()) {
      result_.reason = std::move(*error);
      return std::move(result_);
    }
    std::exception_ptr first;
    try {
      while (!is_over()) step();
    } catch (const std::exception& error) {
      first = std::current_exception();
      limiter_->fault(error.what());  // After any error, the arm must stop.
      keep(error.what());
    }
    try {
      if (first) watcher_.reported(rig_.now(), limiter_->fault()->reason);
      come_to_rest();
    } catch (...) {
      // The watcher fails, for example with a full log. The first error is the reason.
      (void)rig_.ports().arm->halt();
      if (first) std::rethrow_exception(first);
      throw;
    }
    if (result_.reason.empty() && limiter_->fault()) result_.reason = limiter_->fault()->reason;
    result_.is_done = result_.reason.empty();
    result_.fault = kept_;
    result_.first = observer_.first(), result_.last = observer_.last();
    if (result_.last) result_.sigma = observer_.sigma_of_last();
    if (result_.missed_steps > 0)
      watcher_.reported(rig_.now(), fmt::format("{} control steps of {:.4g} s were skipped",
                                                result_.missed_steps, config_.step));
    tally_->finish(result_);
    return std::move(result_);
  }

 private:
  // Equal within quantisation and backlash of the drives.
  static bool is_near(const ArmState& a, const ArmState& b) {
    constexpr double near = 0.02;  // In rad; also for the stretch.
    if (a.bends.size() != b.bends.size()) return false;
    for (std::size_t i = 0; i < a.bends.size(); ++i)
      if (!((a.bends[i] - b.bends[i]).norm() < near) || !(std::abs(a.stretches[i] - b.stretches[i]) < near))
        return false;
    return true;
  }

  RigReader::Error begin() {
    for (std::size_t i = 0; config_.follow && i < 2; ++i)
      if (const std::string why = missing_head(rig_.camera(i)); !why.empty())
        return why + ", and the servo needs both heads to follow the arm";
    if (auto error = rig_.read()) return error;
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < config_.goals.size(); ++i) {
      const double missed = config_.goals[i].missed;
      if (missed > result_.missed) result_.missed = missed, farthest = i;
    }
    if (result_.missed > config_.tolerance)
      return fmt::format(
          "not reachable: the nearest shape of this arm is {:.3g} % of its length away from target {}",
          100 * result_.missed, farthest + 1);
    goals_.emplace(config_.goals, model_.arm, meter_, observer_, *features_, rig_.views(result_.start));
    if (!goals_->problem().empty()) return goals_->problem();
    // The time to measure pictures of targets does not count as the loop's.
    if (rig_.now() > result_.start) {
      result_.start = rig_.now();
      if (auto error = rig_.read()) return error;
    }
    sent_ = rig_.measured(result_.start);
    if (config_.sent && is_near(*config_.sent, sent_)) sent_ = *config_.sent;
    sent_before_ = sent_;
    try {
      limiter_.emplace(nominal_arm_, limiter_config(config_), sent_);
    } catch (const std::invalid_argument& error) {
      return fmt::format("the arm cannot be controlled from its present state: {}", error.what());
    }
    judge_.emplace(config_, result_.start, goals_->last());
    tally_.emplace(model_.arm, config_, result_.start, goals_->last());
    observer_.begin(result_.start);
    return std::nullopt;
  }

  [[nodiscard]] bool is_over() {
    if (result_.reason.empty()) {
      if (judge_->is_done() && !limiter_->fault()) return true;
      if (watcher_.is_cancelled()) result_.reason = "cancelled";
      if (const auto& why = judge_->failure()) result_.reason = *why + likely_cause();
      if (limiter_->fault()) result_.reason = limiter_->fault()->reason;
    }
    if (!result_.reason.empty()) keep(result_.reason);
    return !result_.reason.empty();
  }

  // Keeps the last observations and commands. The first of several reasons counts, with its time.
  void keep(const std::string& reason) {
    if (kept_) return;
    kept_ = limiter_->fault() ? *limiter_->fault() : limiter_->record(reason);
    kept_->time = rig_.now() - result_.start;
  }

  // Waits until the time of the next command, then reads all devices. Skips times that have passed. Commands
  // follow each other in whole steps, because the limiter moves the arm at this rate.
  void wake() {
    constexpr double rounding = 1e-6;
    double passed = std::ceil((rig_.now() - result_.start) / config_.step - rounding);
    constexpr double most = 1e15;
    if (!(passed < most)) passed = 0, fault("the clock's time is out of range for a servo");
    const long next = std::max(ticks_ + 1, static_cast<long>(passed));
    if (next > ticks_ + 1 && result_.missed_steps == 0)
      watcher_.reported(rig_.now(),
                        fmt::format("a control step took longer than {:.4g} s: the missed steps are skipped",
                                    config_.step));
    if (next > ticks_ + 1) sent_before_ = sent_;  // The arm has stopped meanwhile.
    result_.missed_steps += next - ticks_ - 1;
    ticks_ = next;
    rig_.ports().clock->wait_until(result_.start + config_.step * static_cast<double>(ticks_));
    if (auto error = rig_.read()) fault(*error);
  }

  void fault(const std::string& what) {
    if (!limiter_->fault()) watcher_.reported(rig_.now(), what);
    limiter_->fault(what);
    keep(what);
  }

  // Estimates a shape from the newest pictures. Returns true if they give one.
  bool look(double now) {
    const std::optional<PicturePair> pair = rig_.newest_pair();
    if (!pair) {
      std::string why = rig_.silence();
      if (why.empty() && is_blind(now)) why = rig_.no_pair(observer_.seen_since());
      if (!why.empty()) report_unseen(now, std::move(why));
      return false;
    }
    const bool was_seen = observer_.last() != nullptr;
    const bool tracks_model = config_.track == ServoTracking::model;
    const auto observed = std::make_shared<ServoObservation>(
        meter_.measure(*pair, tracks_model ? std::optional(observer_.prediction(pair->time())) : std::nullopt,
                       observer_.predicted_shape(pair->time())));
    TargetShape desired = goals_->at(observed->time - result_.start);
    observed->desired = std::move(desired.state), observed->desired_offset = std::move(desired.offset);
    const bool is_found = observer_.observe(observed, now);
    watcher_.seen(*observed);
    if (!is_found) {
      report_unseen(now, no_shape(*observed));
      return false;
    }
    if (!unseen_because_.empty() && was_seen) watcher_.reported(now, "the arm is visible again");
    unseen_because_.clear();
    return true;
  }

  [[nodiscard]] bool is_blind(double now) const { return observer_.blind_for(now) > config_.hold_after; }

  // Returns the reason why the pictures give no shape.
  [[nodiscard]] std::string no_shape(const ServoObservation& observed) const {
    for (std::size_t i = 0; i < 2; ++i)
      if (!observed.reasons[i].empty())
        return fmt::format("camera {} does not see the arm: {}", rig_.name(i), observed.reasons[i]);
    return rig_.by_name(observed.estimate.reason);
  }

  void report_unseen(double now, std::string why) {
    if (unseen_because_.empty()) watcher_.reported(now, why);
    unseen_because_ = std::move(why);
  }

  void step() {
    wake();
    const double now = rig_.now();
    ServoStep step;
    step.time = now;
    if (!limiter_->fault() && look(now)) {
      step.is_fresh = true;
      limiter_->observe(observer_.last()->estimate.shape.state);
      if (watch_) watch_disturbance(now);
      if (config_.follow) follow(step);
    }
    LimitedCommand command;
    if (!observer_.last() || is_blind(now) || limiter_->fault() || (watch_ && watch_->is_disturbed())) {
      command = limiter_->brake();
    } else {
      const ArmState output = asked(now, step), slow = limiter_->within_braking(output, config_.rate);
      command = limiter_->next(slow);
      if (command.reason.empty()) command.reason = at_its_limit(output);
      if (command.reason.empty() && model_law_) command.reason = model_law_->limit();
      if (command.reason.empty() && slow.bends != output.bends) command.reason = "the motors' acceleration";
    }
    if (observer_.blind_for(now) > config_.give_up_after)
      result_.reason = "out of view: " +
                       (unseen_because_.empty() ? rig_.no_pair(observer_.seen_since()) : unseen_because_);
    step.limited = command.reason;
    send(now, std::move(command.state), std::move(step));
  }

  // Holds the arm while it is disturbed.
  void watch_disturbance(double now) {
    const ServoObservation& observed = *observer_.last();
    const bool was_disturbed = watch_->is_disturbed();
    watch_->add(observed.time, observed.rest, rig_.measured(observed.time), observer_.sigma());
    if (watch_->is_disturbed() && !was_disturbed) watcher_.reported(now, "disturbed: " + watch_->what());
    if (!watch_->is_disturbed() && was_disturbed) watcher_.reported(now, "the disturbance is over");
    if (watch_->lasts() > config_.give_up_after) result_.reason = "disturbed: " + watch_->what();
  }

  // Returns what may keep the arm from its target, beginning with "; ", or "".
  [[nodiscard]] std::string likely_cause() const {
    const std::string cause = watch_ ? watch_->slow_cause() : std::string();
    return cause.empty() ? cause : "; the arm moved " + cause;
  }

  // Returns the law's command for the last observation.
  [[nodiscard]] ArmState asked(double now, ServoStep& step) {
    const ServoObservation& observed = *observer_.last();
    const ArmState& seen = observed.estimate.shape.state;
    step.seen_at = observed.time, step.seen = seen;
    step.desired = goals_->at(observed.time - result_.start).state;
    step.error = servo_error(model_.arm, seen, step.desired);
    step.sigma = observer_.sigma();
    const double since = now - result_.start;
    step.ahead = servo_error(model_.arm, observer_.expected(model_.bent(sent_)), goals_->at(since).state);
    if (model_law_) {
      step.potential = 0.5 * squared_bends(minus(seen, step.desired));
      return model_law_->command({.now = now, .since_start = since}, sent_, sent_before_, observer_, *goals_);
    }
    const ArmState measured = rig_.measured(observed.time);
    const ServoLaw::Output output = law_.step({.observed = observed,
                                               .is_fresh = step.is_fresh,
                                               .measured = measured,
                                               .sent = sent_,
                                               .then = goals_->at(observed.time - result_.start),
                                               .desired = goals_->at(since),
                                               .next = goals_->at(since + config_.step).state});
    step.is_singular = output.is_singular, step.potential = output.potential;
    return output.asked;
  }

  // Returns a text that names the section at its limit of bend or stretch.
  [[nodiscard]] std::string at_its_limit(const ArmState& state) const {
    constexpr double nearly = 1 - 1e-6;
    for (std::size_t i = 0; i < state.bends.size(); ++i) {
      const Section& section = nominal_arm_.driven().sections[i];
      if (state.bends[i].norm() >= nearly * section.max_bend)
        return fmt::format("section {} is at its bend limit", i + 1);
      const auto& [least, most] = section.stretch_limits;
      if (least < most && (state.stretches[i] * nearly <= least || state.stretches[i] >= nearly * most))
        return fmt::format("section {} is at its stretch limit", i + 1);
    }
    return "";
  }

  void follow(ServoStep& step) {
    const ServoObservation& observed = *observer_.last();
    for (std::size_t i = 0; i < 2; ++i) {
      const auto head = keeper_.turned(i, observed.estimate.shape.state, rig_.stance(i, observed.time).head,
                                       observed.seen[i].view);
      if (!head) continue;
      const auto taken = rig_.camera(i).head->command(*head);
      if (const auto refused = taken.fault()) {
        fault(fmt::format("the head of camera {}: {}", rig_.name(i), text(*refused)));
        return;
      }
      step.heads.push_back({rig_.name(i), head->pan, head->tilt, head->zoom});
    }
  }

  // Commands the arm. A real clock goes on while a step is computed, so that commands come more or less late.
  // Each motion therefore begins when the last one ends: none is faster than the limiter allows.
  void report_arm(const ArmState& state) {
    const double now = rig_.now(), duration = std::max(arm_until_ - now, 0.0) + config_.step;
    arm_until_ = now + duration;
    const auto taken = rig_.ports().arm->command(state, duration);
    if (const auto refused = taken.fault()) {
      // A device that refuses commands may still stop. From then on it is not where the limiter assumes.
      is_deaf_ = true;
      (void)rig_.ports().arm->halt();
      fault("the arm: " + text(*refused));
      return;
    }
    watcher_.arm_sent(now, state, duration);
    sent_before_ = sent_;
    sent_ = state;
  }

  void send(double now, ArmState state, ServoStep step) {
    if (!is_deaf_) report_arm(state);
    if (step.desired.bends.empty()) step.desired = goals_->at(now - result_.start).state;
    step.sent = std::move(state);
    for (const Section& section : model_.arm.sections) step.lengths.push_back(section.length);
    watcher_.stepped(step);
    judge_->add(step);
    tally_->add(step);
    if (config_.keeps_steps) result_.steps.push_back(std::move(step));
  }

  // Follows the limiter's path to rest.
  void come_to_rest() {
    while (!limiter_->is_at_rest()) {
      wake();
      ServoStep step;
      step.time = rig_.now();
      const double now = step.time;
      LimitedCommand command = limiter_->brake();
      step.limited = command.reason;
      send(now, std::move(command.state), std::move(step));
    }
    for (std::size_t i = 0; config_.follow && i < 2; ++i) (void)rig_.camera(i).head->halt();
    // The last command lasts until the time of the next one.
    rig_.ports().clock->wait_until(
        std::max(arm_until_, result_.start + config_.step * static_cast<double>(++ticks_)));
  }

  const RigModel& model_;
  ArmModel nominal_arm_;
  const ServoConfig& config_;
  ServoSessionWatcher& watcher_;
  RigReader rig_;
  PictureMeter meter_;
  ShapeObserver observer_;
  std::unique_ptr<ServoFeatures> features_;
  ServoLaw law_;
  std::optional<ModelLaw> model_law_;  // Instead of law_.
  std::optional<DisturbanceWatch> watch_;
  ViewKeeper keeper_;
  std::optional<ServoGoals> goals_;
  std::optional<CommandLimiter> limiter_;
  std::optional<ServoJudge> judge_;
  std::optional<ServoTally> tally_;
  long ticks_ = 0;
  double arm_until_ = 0;        // Time at which the last commanded motion ends.
  bool is_deaf_ = false;        // The arm has refused a command.
  std::string unseen_because_;  // "" if the newest pictures gave a shape.
  std::optional<LimiterFault> kept_;
  ArmState sent_, sent_before_;
  ServoResult result_;
};

}  // namespace

ServoResult servo_in_session(const RigPorts& ports, const RigModel& nominal, const ServoConfig& config,
                             ServoSessionWatcher& watcher) {
  check(ports, nominal, config);
  return Session(ports, nominal, config, watcher).run();
}

}  // namespace flexura
