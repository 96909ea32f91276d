#include "flexura/experiment/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

constexpr double same_time = 1e-9;  // In s.

// Progress of work between two steps of a run, when nothing is played.
class Aside : public Progress {
 public:
  Aside(Progress& run, std::string_view verb) : run_(run), verb_(verb) {}
  void update(double fraction, std::string_view what) override {
    run_.update(fraction, fmt::format("{} {}", verb_, what));
  }
  [[nodiscard]] bool is_cancelled() const override { return run_.is_cancelled(); }

 private:
  Progress& run_;
  std::string_view verb_;
};

}  // namespace

Player::Player(const Experiment& experiment, RunRecorder& run_recorder, Progress& progress,
               RunWatcher* watcher, const RigFactory& make_rig)
    : experiment_(experiment),
      run_recorder_(run_recorder),
      whole_(progress),
      watcher_(watcher),
      tasks_(task_runners(experiment)),
      progress_(progress, experiment, tasks_),
      schedule_(scheduled()),
      safety_(judged()),
      nominal_{.model = rig_model(experiment.arm_model(), experiment.cameras())},
      played_{0, 0, schedule_.initial(), false, ""} {
  for (const auto& task : tasks_)
    if (task->motion_source() == TaskMotionSource::simulated) publishing_.push_back(task.get());
  const auto is_by_rig = [](const auto& task) { return task->motion_source() == TaskMotionSource::by_rig; };
  // Only the rig gives the motion of an arm that differs from the model.
  const bool is_other = experiment.true_rig().arm.mechanics != ArmMechanics::kinematic ||
                        (experiment.truth && experiment.truth->arm);
  if (experiment.equipment || experiment.record.cameras || is_other || std::ranges::any_of(tasks_, is_by_rig))
    rig_ = make_rig ? make_rig(experiment) : rig_of(experiment, [this] { return whole_.is_cancelled(); });
  if (rig_ && watcher_ != nullptr)
    for (const CameraConfig& camera : experiment.cameras()) optics_.emplace_back(camera);
  plan(0);
}

// Includes simulated tasks with a known start.
Schedule Player::scheduled() {
  std::optional<Aside> progress;
  auto ended = simulate_tasks(experiment_, tasks_, done_, [&](std::size_t task) -> Progress& {
    return progress.emplace(progress_.simulation(task), "simulating");
  });
  if (ended) ended_by_ = std::move(ended);
  return {experiment_, tasks_, done_};
}

SafetyReport Player::judged() {
  Aside progress(progress_.checks(), "checking");
  return checked(schedule_, tasks_, ended_by_, &progress);
}

// Plans the events from that time on. Violations and starts of tasks at one time are in this order.
void Player::plan(double from) {
  run_recorder_.expect(schedule_.steps());
  events_.clear();
  for (const Leg& leg : schedule_.legs())
    events_.push_back({leg.start, Recorder::Level::info, leg.name, fmt::format("{} starts", leg.kind)});
  for (const Violation& violation : safety_.violations)
    events_.push_back({violation.start, Recorder::Level::error, "unsafe", violation.text()});
  for (const auto& [task, motion] : done_) {
    if (tasks_[task]->motion_source() != TaskMotionSource::simulated) continue;
    const bool is_last = ended_by_ && ended_by_->task == task;
    events_.push_back({schedule_.legs()[task].end(), is_last ? Recorder::Level::error : Recorder::Level::info,
                       tasks_[task]->name(), is_last ? ended_by_->failure : "there"});
  }
  std::erase_if(events_, [from](const Event& event) { return event.time < from; });
  std::ranges::stable_sort(events_, {}, &Event::time);
}

void Player::publish_up_to(double time) {
  const auto end = std::ranges::upper_bound(events_, time, {}, &Event::time);
  std::for_each(events_.begin(), end, [this](const Event& event) {
    run_recorder_.log().event(event.time, event.level, event.name, event.text);
  });
  events_.erase(events_.begin(), end);
}

Played Player::play() {
  while (step_ <= schedule_.steps()) {
    played_.is_cancelled = whole_.is_cancelled();
    if (played_.is_cancelled) break;
    const double time = schedule_.time_of_step(step_);
    if (const auto task = rig_task_due(time)) {
      if (!perform(*task)) break;
      continue;
    }
    publish_up_to(time);
    if (ends_with_simulated(time)) break;
    const ArmState state = schedule_.state_at(time);
    if (!is_possible(state)) break;
    play_to(time, state);
    step(time, state);
    report_progress(time);
  }
  if (played_.states == 0) run_recorder_.state(0, 0, played_.last);
  return played_;
}

// Everything before the leg at `time` is done.
void Player::report_progress(double time) {
  const std::size_t now = schedule_.leg_at(time);
  const Leg& leg = schedule_.legs()[now];
  for (; finished_ < now; ++finished_) {
    progress_.simulation(finished_).update(1, leg.name);
    progress_.task(finished_).update(1, leg.name);
  }
  if (now >= tasks_.size()) return;
  const double duration = leg.motion->duration();
  progress_.task(now).update(duration > 0 ? std::min(1.0, (time - leg.start) / duration) : 1.0, leg.name);
}

// Unsafe motions are only simulated.
bool Player::is_rig_played() const { return rig_ && (safety_.is_safe() || rig_->is_simulated()); }

void Player::play_to(double time, const ArmState& state) {
  if (!is_rig_played()) return;
  if (experiment_.record.cameras) {
    rig_->play_to(time, state, [this](const FilmedFrame& filmed) {
      run_recorder_.log().image(
          filmed.camera, filmed.frame,
          filmed.message.empty() ? logged_image(filmed.camera, filmed.frame) : filmed.message);
    });
  } else {
    rig_->pass_to(time, state);
  }
}

void Player::step(double time, const ArmState& state) {
  if (step_ % static_cast<std::size_t>(experiment_.record.every) == 0 || step_ == schedule_.steps()) {
    run_recorder_.state(step_, time, state);
    report_tasks(time);
    if (is_rig_played() && is_reading_due(time)) run_recorder_.readings(*rig_);
  }
  run_recorder_.command(time, state);
  notify_watcher(time, state);
  ++step_;
  played_ = {step_, time, state, false, ""};
}

// Real devices take their time to answer. A run that is late must not become later by its log.
bool Player::is_reading_due(double time) {
  if (rig_->is_simulated()) return true;
  constexpr double longest = 0.5;  // s, without readings
  const double now = rig_->ports().clock->now();
  if (now - time > experiment_.clock.step && now - last_reading_ < longest) return false;
  last_reading_ = now;
  return true;
}

void Player::notify_watcher(double time, const ArmState& state) {
  if (watcher_ == nullptr) return;
  watcher_->state(time, state,
                  is_rig_played() ? camera_readings(rig_->ports(), optics_) : std::vector<CameraReading>());
  RigTruth* truth = is_rig_played() ? rig_->truth() : nullptr;
  if (truth == nullptr || !watcher_->needs_truth()) return;
  // While a task waits for the rig, several clock steps have one time of the rig.
  const double now = rig_->ports().clock->now();
  watcher_->truth(time, {.backbone = truth->backbone(now),
                         .pulled = truth->pulled(now),
                         .tensions = truth->tensions(now),
                         .lost_steps = truth->lost_steps(now),
                         .energy = energy_message(now, truth->energy(now)),
                         .contacts = contact_messages(truth->contacts(now))});
}

void Player::report_tasks(double time) {
  for (TaskRunner* task : publishing_) task->publish_up_to(time, run_recorder_.log());
}

// Returns true if the simulated task that ends the run is over.
bool Player::ends_with_simulated(double time) {
  if (!ended_by_) return false;
  const Leg leg = schedule_.legs()[ended_by_->task];
  if (time < leg.end() - same_time) return false;
  play_to(leg.end(), leg.motion->at(leg.motion->duration()));
  stop_after(leg, fmt::format("{}: {}", leg.name, ended_by_->failure));
  return true;
}

// Ends the run with the state at the task's end, which belongs to no step.
void Player::stop_after(const Leg& leg, const std::string& failure) {
  played_ = {step_, leg.end(), leg.motion->at(leg.motion->duration()), whole_.is_cancelled(), failure};
  run_recorder_.expect(step_);
  run_recorder_.state(step_, leg.end(), played_.last);
  report_tasks(leg.end());
  if (is_rig_played()) run_recorder_.readings(*rig_);
}

// Returns the task for the rig that begins at `time` or before, if it is not done and permitted.
std::optional<std::size_t> Player::rig_task_due(double time) const {
  if (!rig_ || !safety_.is_safe()) return std::nullopt;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    if (tasks_[i]->motion_source() != TaskMotionSource::by_rig || done_.contains(i)) continue;
    return schedule_.legs()[i].start <= time ? std::optional(i) : std::nullopt;
  }
  return std::nullopt;
}

// Performs a task of the rig. Returns true if the run continues after the task.
bool Player::perform(std::size_t task) {
  const Leg leg = schedule_.legs()[task];
  publish_up_to(leg.start);
  const ArmState from = leg.motion->at(0);
  play_to(leg.start, from);
  const RecordSteps record_steps = [this](double until, const std::function<ArmState(double)>& state_at) {
    // A step at the end belongs to the next task.
    for (double time = experiment_.clock.step * static_cast<double>(step_); time < until - same_time;
         time = experiment_.clock.step * static_cast<double>(step_))
      step(time, state_at(time));
  };
  TaskStage stage{
      .rig = *rig_,
      .nominal = nominal_,
      .log = run_recorder_.log(),
      .progress = progress_.task(task),
      .record_steps = record_steps,
      .motors_after = [this](std::span<const ArmState> way) { return run_recorder_.motors_after(way); }};
  const TaskEnd end = tasks_[task]->perform(from, stage);
  run_recorder_.log().task_ended();
  done_[task] = end.motion;
  progress_.task(task).update(1, leg.name);
  schedule_ = !end.failure ? scheduled() : Schedule(experiment_, tasks_, done_);
  safety_ = checked(schedule_, tasks_, ended_by_);
  plan(schedule_.legs()[task].end());
  rig_->skip_to_now();
  if (!end.failure) return true;
  stop_after(schedule_.legs()[task], fmt::format("{}: {}", leg.name, *end.failure));
  return false;
}

}  // namespace flexura
