#include "flexura/experiment/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"
#include "flexura/safety/drive_check.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

// A tip that comes so near to its target, as a part of the arm's length, is there.
constexpr double target_tolerance = 1e-6;

}  // namespace

Schedule::Schedule(const Experiment& experiment, const std::map<std::size_t, MotionPtr>& performed)
    : model_(experiment.arm.model()),
      initial_(arm_state(model_.driven(), experiment.arm.initial)),
      obstacles_(obstacles(experiment.obstacle)),
      step_(experiment.clock.step) {
  if (experiment.drive) drive_ = experiment.drive->drive();
  for (std::size_t i = 0; i < experiment.task.size(); ++i) {
    const auto known = performed.find(i);
    const ArmState from = legs_.empty() ? initial_ : legs_.back().motion->at(legs_.back().motion->duration());
    const MotionPtr motion = known != performed.end() ? known->second : nullptr;
    if (const auto* servo = std::get_if<ServoTask>(&experiment.task[i])) {
      add_servo(*servo, from, motion);
    } else {
      add(experiment.task[i], motion ? motion : task_motion(experiment.task[i], model_, from));
    }
  }
  if (legs_.empty()) legs_.push_back({"start", "hold", 0.0, hold_motion(initial_, 0.0)});
  // A duration of a whole number of steps, but for rounding, takes just that many.
  constexpr double rounding = 1e-9;
  steps_ = static_cast<std::size_t>(std::max(0.0, std::ceil(duration_ / step_ - rounding)));
}

void Schedule::add(const TaskConfig& task, const MotionPtr& motion) {
  legs_.push_back({task_name(task), std::string(task_kind(task)), duration_, motion});
  duration_ += motion->duration();
  const auto target = tip_target(task);
  if (!target) return;
  const double missed = (model_.backbone(motion->at(motion->duration())).tip().position - *target).norm();
  if (missed > target_tolerance * model_.driven().length()) add_missed(missed, target);
}

// Of the last task.
void Schedule::add_missed(double missed, const std::optional<Eigen::Vector3d>& target) {
  missed_targets_.push_back({.hazard = Hazard::workspace,
                             .start = legs_.back().start,
                             .end = duration_,
                             .worst_time = duration_,
                             .name = legs_.back().name,
                             .value = missed,
                             .target = target});
}

// With those of its targets of which the nearest shape of the arm stays farther away than it may.
void Schedule::add_servo(const ServoTask& servo, const ArmState& from, const MotionPtr& known) {
  const auto shapes = servo_target_shapes(servo, model_, from);
  add(servo, known ? known : servo_motion(shapes, model_.driven(), from));
  legs_.back().is_steered = true, legs_.back().is_foreseen = known != nullptr;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!shapes[i] || shapes[i]->missed <= servo.tolerance) continue;
    const auto& position = servo.target[i].position;
    add_missed(shapes[i]->missed * model_.driven().length(),
               position ? std::optional(vector(*position)) : std::nullopt);
    missed_targets_.back().name += fmt::format(": target[{}]", i);
    missed_targets_.back().limit = servo.tolerance * model_.driven().length();
  }
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
  for (const Leg& leg : legs_)
    if (!leg.is_foreseen)
      report.caveats.push_back(fmt::format(
          "{}: judged by a slow and straight way to the shapes that it is told: which way it goes is decided "
          "while it is steered, within all limits, and judged then",
          leg.name));
  if (drive_ && report.is_complete) {
    std::vector<double> times;
    times.reserve(steps_ + 1);
    for (std::size_t step = 0; step <= steps_; ++step) times.push_back(time_of_step(step));
    std::vector<SteeredSpan> steered;
    for (const Leg& leg : legs_)
      if (leg.is_steered) steered.push_back({leg.start, leg.end(), leg.is_foreseen});
    check_drive(
        model_.driven(), *drive_, [this](double time) { return state_at(time); }, times,
        [this](double start, double end) { return rates(start, end); }, report, steered);
  }
  report.sort();
  return report;
}

}  // namespace flexura
