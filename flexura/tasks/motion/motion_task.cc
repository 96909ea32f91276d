#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/kinematics/cord_motion.h"
#include "flexura/kinematics/expression.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"
#include "flexura/math/so3.h"
#include "flexura/model/arm_model.h"
#include "flexura/tasks/motion/keyframes.h"
#include "flexura/tasks/motion/motion_task_config.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

// Returns a section's value: one for all sections, or one each.
template <class T>
const T& of_section(const std::vector<T>& values, std::size_t section) {
  return values.size() == 1 ? values.front() : values[section];
}

// Returns the distance of a section's motion: rad of bend, or stretch with 1 as 1 rad.
double distance(const ArmState& from, const ArmState& to, std::size_t section) {
  return std::max((to.bends[section] - from.bends[section]).norm(),
                  std::abs(to.stretches[section] - from.stretches[section]));
}

// Returns the fastest trapezoid, one for all sections, within each section's rate and acceleration;
// std::nullopt if nothing moves.
std::optional<Profile> shared_trapezoid(const MoveTask& task, const ArmState& from, const ArmState& to) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  double rate = unlimited;  // Of the whole way, 1/s.
  double acceleration = unlimited;
  for (std::size_t i = 0; i < from.bends.size(); ++i) {
    const double way = distance(from, to, i);
    if (way == 0) continue;
    rate = std::min(rate, of_section(*task.max_rate, i) / way);
    acceleration = std::min(acceleration, of_section(*task.max_acceleration, i) / way);
  }
  if (rate == unlimited) return std::nullopt;
  // After a formula with invalid values, the motion takes longer than a run may.
  constexpr double least = 1e-300;
  return Profile::trapezoid(1.0, std::max(rate, least), std::max(acceleration, least));
}

MotionPtr motion_of(const HoldTask& task, const ArmModel&, const ArmState& from) {
  return hold_motion(from, task.duration);
}

// Returns the target pose of the tip, if the task has one.
std::optional<TipTarget> tip_target(const MoveTask& task, const ArmModel& arm) {
  const MoveTarget& to = task.to;
  if (to.tip_of) {
    const Pose X_WT = arm.backbone(arm_state(arm.driven(), *to.tip_of)).tip();
    TipTarget target{.position = X_WT.position};
    if (to.match == TipMatch::direction) target.direction = X_WT.rotation.col(2);
    if (to.match == TipMatch::pose) target.rotation = X_WT.rotation;
    return target;
  }
  if (!to.position) return std::nullopt;
  TipTarget target{.position = vector(*to.position)};
  if (to.direction) target.direction = vector(*to.direction);
  if (to.rotation) target.rotation = rotation_of(*to.rotation);
  return target;
}

// Distances of the tip from its target.
struct TipMiss {
  double position = 0;  // m
  double angle = 0;     // rad

  // Returns the distance, m; an angle counts as its arc at the arm's length.
  [[nodiscard]] double distance(double length) const { return std::max(position, angle * length); }
};

TipMiss miss_of(const TipTarget& target, const Pose& X_WT) {
  TipMiss miss{(X_WT.position - target.position).norm(), 0};
  const Eigen::Vector3d z = X_WT.rotation.col(2);
  if (target.direction) miss.angle = std::atan2(z.cross(*target.direction).norm(), z.dot(*target.direction));
  if (target.rotation) miss.angle = so3_log(X_WT.rotation.transpose() * *target.rotation).norm();
  return miss;
}

// Returns the search for a shape, which starts at the arm's state.
InverseResult search_of(const TipTarget& target, const ArmModel& arm, const ArmState& from) {
  InverseConfig config;
  config.start = from;
  return solve_inverse(arm, target, config);
}

// Returns the entry of a summary about a search. The distances are those of the shape found, from the forward
// kinematics.
Node search_node(const std::string& name, const TipTarget& target, const ArmModel& arm,
                 const InverseResult& found) {
  const TipMiss miss = miss_of(target, arm.backbone(found.state).tip());
  return {Node::Table{{"name", {}, text_node(name)},
                      {"outcome", {}, text_node(std::string(name_of(found.outcome)))},
                      {"converged", {}, {found.converged(), {}}},
                      {"unreachable", {}, {found.is_proven, {}}},
                      {"position_error", {}, number_node(miss.position)},
                      {"angle_error", {}, number_node(miss.angle)},
                      {"iterations", {}, {static_cast<std::int64_t>(found.iterations), {}}},
                      {"starts", {}, {static_cast<std::int64_t>(found.starts), {}}}},
          {}};
}

// Returns the target shape of a move.
ArmState state_to_reach(const MoveTask& task, const ArmModel& arm, const ArmState& from) {
  const auto target = tip_target(task, arm);
  return target ? search_of(*target, arm, from).state : arm_state(arm.driven(), task.to);
}

// Returns the profile of a law that uses the task's duration. Has no default, so that the compiler reports a
// missing law.
Profile profile_of(MoveLaw law, double duration) {
  switch (law) {
    case MoveLaw::linear:
      return Profile::linear(duration);
    case MoveLaw::minimum_jerk:
      return Profile::minimum_jerk(duration);
    case MoveLaw::trapezoid:
      break;
  }
  throw std::logic_error("the law trapezoid computes the duration itself");
}

MotionPtr motion_of(const MoveTask& task, const ArmModel& model, const ArmState& from) {
  const Arm& arm = model.driven();
  const ArmState to = state_to_reach(task, model, from);
  if (task.law.front() == MoveLaw::trapezoid) {
    const auto trapezoid = shared_trapezoid(task, from, to);
    if (!trapezoid) return hold_motion(from, 0);
    return point_to_point_motion(from, to, std::vector<Profile>(arm.sections.size(), *trapezoid));
  }
  std::vector<Profile> profiles;
  profiles.reserve(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i)
    profiles.push_back(profile_of(of_section(task.law, i), task.duration.value_or(1.0)));
  // With one law for all, cords and bends both move on straight lines.
  if (task.to.cord_angles && task.law.size() > 1) {
    std::vector<double> changes = *task.to.cord_angles;
    const std::vector<double> first = cord_angles(arm, from);
    for (std::size_t i = 0; i < changes.size(); ++i) changes[i] -= first[i];
    return cord_point_to_point_motion(from, to, std::move(changes), std::move(profiles));
  }
  return point_to_point_motion(from, to, std::move(profiles));
}

MotionPtr motion_of(const SineTask& task, const ArmModel& model, const ArmState& from) {
  const Arm& arm = model.driven();
  std::vector<double> phases;
  phases.reserve(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i) phases.push_back(of_section(task.phase, i));
  if (task.amplitude.cord_angles)
    return cord_sine_motion(from, *task.amplitude.cord_angles, phases, task.period, task.duration);
  return sine_motion(from, arm_state(arm, task.amplitude).bends, std::move(phases), task.period,
                     task.duration);
}

MotionPtr motion_of(const KeyframesTask& task, const ArmModel& model, const ArmState&) {
  const Arm& arm = model.driven();
  return keyframes_task_motion(task, arm);
}

// Formulas of one quantity, one for all sections or one each.
class Formulas {
 public:
  explicit Formulas(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) formulas_.emplace_back(text);
  }
  [[nodiscard]] double value(double t, double T, std::size_t section) const {
    return of_section(formulas_, section).value(t, T, section + 1);
  }

 private:
  std::vector<Expression> formulas_;
};

std::vector<double> values_of(const Formulas& formulas, double t, double T, std::size_t sections) {
  std::vector<double> values;
  values.reserve(sections);
  for (std::size_t i = 0; i < sections; ++i) values.push_back(formulas.value(t, T, i));
  return values;
}

MotionPtr motion_of(const ExpressionTask& task, const ArmModel& model, const ArmState& from) {
  const Arm& arm = model.driven();
  struct Law {
    std::optional<Formulas> cord_angles, archings, bends_x, bends_y, stretches;
  };
  auto law = std::make_shared<Law>();
  if (task.cord_angles) law->cord_angles.emplace(*task.cord_angles);
  if (task.archings) law->archings.emplace(*task.archings);
  if (task.stretches) law->stretches.emplace(*task.stretches);
  if (task.bends) {
    std::vector<std::string> x;
    std::vector<std::string> y;
    for (const auto& [bend_x, bend_y] : *task.bends) {
      x.push_back(bend_x);
      y.push_back(bend_y);
    }
    law->bends_x.emplace(x);
    law->bends_y.emplace(y);
  }
  return function_motion(task.duration, [law, arm, from, T = task.duration](double t) {
    const std::size_t n = arm.sections.size();
    ShapeConfig shape;
    if (law->cord_angles) shape.cord_angles = values_of(*law->cord_angles, t, T, n);
    if (law->archings) shape.archings = values_of(*law->archings, t, T, n);
    ArmState state = shape.cord_angles || shape.archings ? arm_state(arm, shape) : from;
    state.stretches = from.stretches;
    for (std::size_t i = 0; i < n; ++i) {
      if (law->bends_x) state.bends[i] = {law->bends_x->value(t, T, i), law->bends_y->value(t, T, i)};
      if (law->stretches) state.stretches[i] = law->stretches->value(t, T, i);
    }
    return state;
  });
}

// Return the approximate duration of a motion, s.
double duration_of(const MoveTask& task) { return task.duration.value_or(1); }
template <class Task>
double duration_of(const Task& task) {
  return task.duration;
}
double duration_of(const KeyframesTask& task) {
  const auto time = std::ranges::find(task.columns, "time");
  if (time == task.columns.end() || task.rows.empty()) return 0;
  return task.rows.back().at(static_cast<std::size_t>(time - task.columns.begin()));
}

// Returns the result of a motion of this duration, in words.
std::string text_of(const MoveTask& task, double distance_to_target, double duration) {
  return task.to.is_of_tip()
             ? fmt::format("tip {} from its target after {:.4g} s", length_text(distance_to_target), duration)
             : fmt::format("at the target shape after {:.4g} s", duration);
}

std::string text_of(const HoldTask& /*task*/, double /*distance*/, double duration) {
  return fmt::format("held for {:.4g} s", duration);
}

std::string text_of(const SineTask& task, double /*distance*/, double duration) {
  return fmt::format("{:.4g} periods in {:.4g} s", duration / task.period, duration);
}

std::string text_of(const KeyframesTask& task, double /*distance*/, double duration) {
  return fmt::format("through {} shapes in {:.4g} s", task.rows.size(), duration);
}

std::string text_of(const ExpressionTask& /*task*/, double /*distance*/, double duration) {
  return fmt::format("followed the formulas for {:.4g} s", duration);
}

// A task whose motion is known from its start.
template <class Task>
class MotionRunner : public TaskRunner {
 public:
  MotionRunner(const Task& task, const Setup& setup, TaskLabel label)
      : TaskRunner(setup, std::move(label)), task_(task) {}

  [[nodiscard]] TaskPlan plan(const ArmState& from, const MotionPtr& /*done*/) const override {
    const ArmModel arm = setup().arm_model();
    from_ = from;
    TaskPlan plan{.motion = motion_of(task_, arm, from)};
    if constexpr (std::is_same_v<Task, MoveTask>) add_missed(arm, plan);
    return plan;
  }

  [[nodiscard]] TaskWork work() const override { return {.duration = duration_of(task_)}; }

  [[nodiscard]] TaskOutcome outcome(const Motion& motion) const override {
    TaskOutcome outcome{.task = name(),
                        .kind = std::string(fields_of(static_cast<const Task*>(nullptr)).info().name),
                        .noun = "motion",
                        .success = "done",
                        .text = {},
                        .size = {}};
    double missed = 0;
    if constexpr (std::is_same_v<Task, MoveTask>) {
      const ArmModel arm = setup().arm_model();
      missed = missed_by(arm, motion);
      outcome.is_reached = missed <= tolerance * arm.driven().length();
      if (task_.to.is_of_tip()) {
        outcome.size = missed;
        outcome.size_text = fmt::format("tip {} from its target", length_text(missed));
      }
    }
    outcome.text = text_of(task_, missed, motion.duration());
    return outcome;
  }

  [[nodiscard]] std::string_view summary_list() const override {
    return std::is_same_v<Task, MoveTask> ? "moves" : "";
  }
  [[nodiscard]] std::optional<Node> summary() const override {
    if constexpr (std::is_same_v<Task, MoveTask>) {
      const ArmModel arm = setup().arm_model();
      const auto target = tip_target(task_, arm);
      if (target && from_) return search_node(name(), *target, arm, search_of(*target, arm, *from_));
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<ReportSpace::Target> targets(const Motion& motion) const override {
    if constexpr (std::is_same_v<Task, MoveTask>) {
      const double end = motion.duration();
      return {{.name = name(),
               .start = 0,
               .end = end,
               .shape = setup().arm_model().backbone(motion.at(end)),
               .position = tip_position(setup().arm_model())}};
    }
    return {};
  }

 private:
  // Share of the arm's length: a tip this near to its target has reached it.
  static constexpr double tolerance = 1e-6;

  // Returns the target position of the tip, m.
  [[nodiscard]] std::optional<Eigen::Vector3d> tip_position(const ArmModel& arm) const {
    const auto target = tip_target(task_, arm);
    return target ? std::optional(target->position) : std::nullopt;
  }

  // Returns the distance of the tip from its target at the end, m; 0 without a target.
  [[nodiscard]] double missed_by(const ArmModel& arm, const Motion& motion) const {
    const auto target = tip_target(task_, arm);
    if (!target) return 0;
    return miss_of(*target, arm.backbone(motion.at(motion.duration())).tip()).distance(arm.driven().length());
  }

  void add_missed(const ArmModel& arm, TaskPlan& plan) const {
    const double missed = missed_by(arm, *plan.motion);
    if (missed > tolerance * arm.driven().length())
      plan.missed.push_back({.place = "", .distance = missed, .limit = 0, .position = tip_position(arm)});
  }

  mutable std::optional<ArmState> from_;  // Of the last plan, for the summary of its search.
  const Task& task_;
};

}  // namespace

std::unique_ptr<TaskRunner> runner_of(const MoveTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<MotionRunner<MoveTask>>(task, setup, std::move(label));
}

std::unique_ptr<TaskRunner> runner_of(const HoldTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<MotionRunner<HoldTask>>(task, setup, std::move(label));
}

std::unique_ptr<TaskRunner> runner_of(const SineTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<MotionRunner<SineTask>>(task, setup, std::move(label));
}

std::unique_ptr<TaskRunner> runner_of(const KeyframesTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<MotionRunner<KeyframesTask>>(task, setup, std::move(label));
}

std::unique_ptr<TaskRunner> runner_of(const ExpressionTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<MotionRunner<ExpressionTask>>(task, setup, std::move(label));
}

}  // namespace flexura
