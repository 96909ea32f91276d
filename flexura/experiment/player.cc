#include "flexura/experiment/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

constexpr double same_time = 1e-9;  // s

// What is told of work between two steps of a run: how far that is, in words, for nothing is played
// meanwhile.
class Aside : public Progress {
 public:
  // `played`: how far the run is, of 1.
  Aside(Progress& run, double played, std::string_view verb) : run_(run), played_(played), verb_(verb) {}
  void update(double fraction, std::string_view what) override {
    run_.update(played_, fmt::format("{} {}, {:.0f} %", verb_, what, 100 * fraction));
  }
  [[nodiscard]] bool is_cancelled() const override { return run_.is_cancelled(); }

 private:
  Progress& run_;
  double played_;
  std::string_view verb_;
};

}  // namespace

Player::Player(const Experiment& experiment, Witness& witness, Progress& progress, RunWatcher* watcher)
    : experiment_(experiment),
      witness_(witness),
      progress_(progress),
      watcher_(watcher),
      schedule_(scheduled(0)),
      safety_(judged()),
      believed_(rig_model(experiment.arm.arm(), experiment.cameras())),
      played_{0, 0, schedule_.initial(), false, ""} {
  if (experiment.record.cameras || std::ranges::any_of(experiment.task, is_for_rig))
    filming_.emplace(experiment);
  plan(0);
}

// With what tasks of dynamics do that begin where it is known.
Schedule Player::scheduled(double played) {
  Aside progress(progress_, played, "simulating");
  run_known_dynamics(experiment_, performed_, dynamics_, progress);
  return Schedule(experiment_, performed_);
}

SafetyReport Player::judged() {
  Aside progress(progress_, 0, "checking");
  return checked(experiment_, schedule_, dynamics_, &progress);
}

// What is to be told from that time on; violations and the starts of tasks at one time in this order of
// tasks.
void Player::plan(double from) {
  witness_.expect(schedule_.steps());
  events_.clear();
  for (const Leg& leg : schedule_.legs())
    events_.push_back({leg.start, Recorder::Level::info, leg.name, fmt::format("{} starts", leg.kind)});
  for (const Violation& violation : safety_.violations)
    events_.push_back({violation.start, Recorder::Level::error, "unsafe", violation.text()});
  for (const DynamicsRun& run : dynamics_)
    events_.push_back({schedule_.legs()[run.task].end(),
                       run.is_done() ? Recorder::Level::info : Recorder::Level::error, run.name,
                       run.is_done() ? "there" : run.reason()});
  std::erase_if(events_, [from](const Event& event) { return event.time < from; });
  std::ranges::stable_sort(events_, {}, &Event::time);
}

void Player::tell_up_to(double time) {
  const auto end = std::ranges::upper_bound(events_, time, {}, &Event::time);
  std::for_each(events_.begin(), end, [this](const Event& event) {
    witness_.event(event.time, event.level, event.name, event.text);
  });
  events_.erase(events_.begin(), end);
}

Played Player::play() {
  while (step_ <= schedule_.steps()) {
    played_.is_cancelled = progress_.is_cancelled();
    if (played_.is_cancelled) break;
    const double time = schedule_.time_of_step(step_);
    if (const auto task = rig_task_due(time)) {
      if (!perform(*task)) break;
      continue;
    }
    tell_up_to(time);
    if (ends_with_dynamics(time)) break;
    const ArmState state = schedule_.state_at(time);
    if (!is_possible(state)) break;
    film_to(time, state);
    step(time, state);
    progress_.update(schedule_.duration() > 0 ? time / schedule_.duration() : 1.0,
                     schedule_.legs()[schedule_.leg_at(time)].name);
  }
  if (played_.states == 0) witness_.state(0, 0, played_.last);
  return played_;
}

void Player::film_to(double time, const ArmState& state) {
  if (!filming_) return;
  if (experiment_.record.cameras) {
    filming_->play_to(time, state, [this](const FilmedFrame& filmed) {
      witness_.image(filmed.camera, filmed.frame, filmed.message);
    });
  } else {
    filming_->pass_to(time, state);
  }
}

void Player::step(double time, const ArmState& state) {
  if (step_ % static_cast<std::size_t>(experiment_.record.every) == 0 || step_ == schedule_.steps()) {
    witness_.state(step_, time, state);
    tell_dynamics(time);
    if (filming_) read_rig();
  }
  witness_.command(time, state);
  if (watcher_ != nullptr)
    watcher_->state(time, state, filming_ ? filming_->camera_readings() : std::vector<CameraReading>());
  ++step_;
  played_ = {step_, time, state, false, ""};
}

void Player::read_rig() {
  const RigPorts ports = filming_->ports();
  witness_.readings(ports, filming_->true_backbone(ports.clock->now()));
}

// Of each run of dynamics what it began and ended with, and what it had come to.
void Player::tell_dynamics(double time) {
  for (; dynamics_told_ < dynamics_.size(); ++dynamics_told_, samples_told_ = 0) {
    const DynamicsRun& run = dynamics_[dynamics_told_];
    const auto is_past = [&](std::size_t i) {
      return run.start + run.samples[i].energies.time <= time + same_time;
    };
    for (const std::size_t count = run.samples.size(); samples_told_ < count; ++samples_told_) {
      if (!is_past(samples_told_)) return;
      const bool is_end = samples_told_ == 0 || samples_told_ + 1 == count;
      if (is_end || !is_past(samples_told_ + 1)) witness_.dynamics(run.message(run.samples[samples_told_]));
    }
  }
}

// Whether a task of dynamics that is not done is over, and the run with it.
bool Player::ends_with_dynamics(double time) {
  if (dynamics_.empty() || dynamics_.back().is_done()) return false;
  const DynamicsRun& run = dynamics_.back();
  const Leg leg = schedule_.legs()[run.task];
  if (time < leg.end() - same_time) return false;
  film_to(leg.end(), leg.motion->at(leg.motion->duration()));
  stop_after(leg, fmt::format("{}: {}", run.name, run.reason()));
  return true;
}

// The run ends here: with the state at the end, which belongs to no step.
void Player::stop_after(const Leg& leg, const std::string& failure) {
  played_ = {step_, leg.end(), leg.motion->at(leg.motion->duration()), progress_.is_cancelled(), failure};
  witness_.expect(step_);
  witness_.state(step_, leg.end(), played_.last);
  tell_dynamics(leg.end());
  if (filming_) read_rig();
}

// The task for the rig that begins at `time` or before, if it was not done yet and may be done.
std::optional<std::size_t> Player::rig_task_due(double time) const {
  if (!filming_ || !safety_.is_safe()) return std::nullopt;
  for (std::size_t i = 0; i < experiment_.task.size(); ++i) {
    if (!is_for_rig(experiment_.task[i]) || performed_.contains(i)) continue;
    return schedule_.legs()[i].start <= time ? std::optional(i) : std::nullopt;
  }
  return std::nullopt;
}

Player::Performed Player::calibrate(std::size_t task, const ArmState& from, const RecordSteps& record_steps) {
  CalibrationRun run = run_calibration(experiment_, task, from, *filming_, witness_, progress_, record_steps);
  if (run.is_done()) learn(run);
  calibrations_.push_back(std::move(run));
  const CalibrationRun& done = calibrations_.back();
  return {done.motion, done.is_done() ? "" : fmt::format("{}: {}", done.name, done.reason())};
}

// A rig; or from a loop principal points alone, which are beside the file's: nothing for a rig that was
// found.
void Player::learn(const CalibrationRun& run) {
  const RigModel found = run.found();
  if (!run.loop) believed_ = found, is_rig_found_ = true;
  for (std::size_t i = 0; run.loop && !is_rig_found_ && i < 2; ++i) {
    const std::size_t camera = run.loop->stances[i].camera;
    if (run.loop->principal_point[i]) believed_.cameras[camera] = found.cameras[camera];
  }
}

Player::Performed Player::servo(std::size_t task, const ArmState& from, const RecordSteps& record_steps) {
  servos_.push_back(
      run_servo(experiment_, task, believed_, from, *filming_, witness_, progress_, record_steps));
  const ServoRun& done = servos_.back();
  return {done.motion, done.result.is_done ? "" : fmt::format("{}: {}", done.name, done.result.reason)};
}

// Whether the run goes on after it.
bool Player::perform(std::size_t task) {
  const Leg leg = schedule_.legs()[task];
  tell_up_to(leg.start);
  const ArmState from = leg.motion->at(0);
  film_to(leg.start, from);
  const RecordSteps record_step = [this](double until, const std::function<ArmState(double)>& state_at) {
    // A step at the end is the next task's.
    for (double time = experiment_.clock.step * static_cast<double>(step_); time < until - same_time;
         time = experiment_.clock.step * static_cast<double>(step_))
      step(time, state_at(time));
  };
  const bool is_servo = std::holds_alternative<ServoTask>(experiment_.task[task]);
  const Performed done = is_servo ? servo(task, from, record_step) : calibrate(task, from, record_step);
  performed_[task] = done.motion;
  const double played = schedule_.duration() > 0 ? leg.start / schedule_.duration() : 0;
  schedule_ = done.failure.empty() ? scheduled(played) : Schedule(experiment_, performed_);
  safety_ = checked(experiment_, schedule_, dynamics_);
  plan(schedule_.legs()[task].end());
  filming_->skip_to_now();
  if (done.failure.empty()) return true;
  stop_after(schedule_.legs()[task], done.failure);
  return false;
}

}  // namespace flexura
