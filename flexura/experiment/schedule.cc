#include "flexura/experiment/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/kinematics/shape.h"
#include "flexura/safety/drive_check.h"
#include "flexura/safety/motion_check.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {

TaskRunners task_runners(const Experiment& experiment) {
  TaskRunners tasks;
  tasks.reserve(experiment.task.size());
  for (std::size_t i = 0; i < experiment.task.size(); ++i)
    tasks.push_back(task_runner(experiment.task[i], experiment, i));
  return tasks;
}

Schedule::Schedule(const Experiment& experiment) : Schedule(experiment, task_runners(experiment), {}) {}

Schedule::Schedule(const Experiment& experiment, const TaskRunners& tasks, const DoneTasks& done)
    : model_(experiment.arm_model()),
      initial_(arm_state(model_.driven(), experiment.arm.initial)),
      obstacles_(obstacles(experiment.obstacle)),
      step_(experiment.clock.step) {
  if (experiment.drive) drive_ = experiment.drive->drive();
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const auto known = done.find(i);
    const ArmState from = legs_.empty() ? initial_ : legs_.back().motion->at(legs_.back().motion->duration());
    const TaskPlan plan = tasks[i]->plan(from, known != done.end() ? known->second : nullptr);
    legs_.push_back({.name = tasks[i]->name(),
                     .kind = std::string(task_kind(experiment.task[i])),
                     .start = duration_,
                     .motion = plan.motion,
                     .is_steered = plan.is_steered,
                     .is_planned = plan.is_planned});
    duration_ += plan.motion->duration();
    for (const MissedTarget& missed : plan.missed) add_missed(missed);
  }
  if (legs_.empty()) legs_.push_back({"start", "hold", 0.0, hold_motion(initial_, 0.0)});
  // A duration of a whole number of steps, up to rounding, takes exactly that many.
  constexpr double rounding = 1e-9;
  steps_ = static_cast<std::size_t>(std::max(0.0, std::ceil(duration_ / step_ - rounding)));
}

// For the last task.
void Schedule::add_missed(const MissedTarget& missed) {
  const Leg& leg = legs_.back();
  missed_targets_.push_back({.hazard = Hazard::workspace,
                             .start = leg.start,
                             .end = duration_,
                             .worst_time = duration_,
                             .name = missed.place.empty() ? leg.name : leg.name + ": " + missed.place,
                             .value = missed.distance,
                             .limit = missed.limit,
                             .target = missed.position});
}

double Schedule::time_of_step(std::size_t step) const {
  return step == steps_ ? duration_ : static_cast<double>(step) * step_;
}

std::size_t Schedule::leg_at(double time) const {
  const auto after = std::ranges::upper_bound(legs_, time, {}, &Leg::start);
  return after == legs_.begin() ? 0 : static_cast<std::size_t>(after - legs_.begin()) - 1;
}

ArmState Schedule::state_at(double time) const {
  const Leg& leg = legs_[leg_at(time)];
  return leg.motion->at(std::clamp(time - leg.start, 0.0, leg.motion->duration()));
}

std::optional<std::vector<SectionRates>> Schedule::rates(double start, double end) const {
  std::vector<SectionRates> most(model_.driven().sections.size());
  for (std::size_t k = leg_at(start); k < legs_.size() && legs_[k].start <= end; ++k) {
    const Leg& leg = legs_[k];
    const double duration = leg.motion->duration();
    const double from = std::clamp(start - leg.start, 0.0, duration);
    const double to = std::clamp(end - leg.start, 0.0, duration);
    for (std::size_t i = 0; i < most.size(); ++i) {
      const auto rates = leg.motion->rates(i, from, to);
      if (!rates) return std::nullopt;
      most[i].bend = std::max(most[i].bend, rates->bend);
      most[i].stretch = std::max(most[i].stretch, rates->stretch);
    }
  }
  return most;
}

SafetyReport Schedule::check(Progress* progress) const {
  std::vector<TimedMotion> motions;
  motions.reserve(legs_.size());
  for (const Leg& leg : legs_) motions.push_back({leg.motion, leg.start, leg.name});
  SafetyReport report = check_motions(model_, obstacles_, initial_, motions, step_, progress);
  report.violations.insert(report.violations.end(), missed_targets_.begin(), missed_targets_.end());
  if (drive_ && report.is_complete) {
    std::vector<double> times;
    times.reserve(steps_ + 1);
    for (std::size_t step = 0; step <= steps_; ++step) times.push_back(time_of_step(step));
    std::vector<SteeredSpan> steered;
    for (const Leg& leg : legs_)
      if (leg.is_steered) steered.push_back({leg.start, leg.end(), leg.is_planned});
    check_drive(
        model_.driven(), *drive_, [this](double time) { return state_at(time); }, times,
        [this](double start, double end) { return rates(start, end); }, report, steered);
  }
  report.sort();
  return report;
}

std::optional<EndedBy> simulate_tasks(const Experiment& experiment, const TaskRunners& tasks, DoneTasks& done,
                                      const std::function<Progress&(std::size_t task)>& progress_of) {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (done.contains(i)) continue;
    if (tasks[i]->motion_source() == TaskMotionSource::by_rig) return std::nullopt;
    if (tasks[i]->motion_source() == TaskMotionSource::known) continue;
    const Leg leg = Schedule(experiment, tasks, done).legs()[i];
    const ArmState from = leg.motion->at(0);
    if (!is_possible(from)) return std::nullopt;  // The run ends before.
    TaskEnd end = tasks[i]->simulate(from, leg.start, progress_of(i));
    done[i] = end.motion;
    if (end.failure) return EndedBy{i, std::move(*end.failure)};
  }
  return std::nullopt;
}

SafetyReport checked(const Schedule& schedule, const TaskRunners& tasks,
                     const std::optional<EndedBy>& ended_by, Progress* progress) {
  SafetyReport report = schedule.check(progress);
  const std::string last = ended_by ? tasks[ended_by->task]->name() : "";
  for (std::size_t i = 0; i < tasks.size(); ++i)
    tasks[i]->add_caveats(schedule.legs()[i].motion->at(0), last, report);
  return report;
}

SafetyReport check_experiment_safety(const Experiment& experiment, Progress& progress) {
  const TaskRunners tasks = task_runners(experiment);
  DoneTasks done;
  const auto ended_by =
      simulate_tasks(experiment, tasks, done, [&](std::size_t /*task*/) -> Progress& { return progress; });
  const Schedule schedule(experiment, tasks, done);
  SafetyReport report = checked(schedule, tasks, ended_by, &progress);
  if (ended_by)
    report.notes.insert(report.notes.begin(),
                        fmt::format("{}: {}", tasks[ended_by->task]->name(), ended_by->failure));
  return report;
}

double play_unfilmed(double until, const Schedule& schedule, Rig& rig) {
  double played = 0;
  for (std::size_t step = 0; step <= schedule.steps(); ++step) {
    const double time = schedule.time_of_step(step);
    const ArmState state = schedule.state_at(time);
    if (!is_possible(state)) break;
    rig.pass_to(time, state);
    played = time;
    if (time >= until) break;
  }
  return played;
}

}  // namespace flexura
