#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/experiment/dynamics_plant.h"
#include "flexura/experiment/keyframes.h"
#include "flexura/experiment/task_config.h"
#include "flexura/kinematics/cord_motion.h"
#include "flexura/kinematics/expression.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/shape.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

// One value for all sections, or one each.
template <class T>
const T& of_section(const std::vector<T>& values, std::size_t section) {
  return values.size() == 1 ? values.front() : values[section];
}

// How far a section goes: rad of bend, and stretch as if 1 were 1 rad.
double distance(const ArmState& from, const ArmState& to, std::size_t section) {
  return std::max((to.bends[section] - from.bends[section]).norm(),
                  std::abs(to.stretches[section] - from.stretches[section]));
}

// The fastest trapezoid, one for all sections, with which none exceeds its own rate and acceleration; none
// where there is no way to go.
std::optional<Profile> shared_trapezoid(const MoveTask& task, const ArmState& from, const ArmState& to) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  double rate = unlimited;  // of the whole way, 1/s
  double acceleration = unlimited;
  for (std::size_t i = 0; i < from.bends.size(); ++i) {
    const double way = distance(from, to, i);
    if (way == 0) continue;
    rate = std::min(rate, of_section(*task.max_rate, i) / way);
    acceleration = std::min(acceleration, of_section(*task.max_acceleration, i) / way);
  }
  if (rate == unlimited) return std::nullopt;
  // A formula may leave the arm nowhere; the way from there takes longer than a run may.
  constexpr double least = 1e-300;
  return Profile::trapezoid(1.0, std::max(rate, least), std::max(acceleration, least));
}

MotionPtr motion_of(const HoldTask& task, const ArmModel&, const ArmState& from) {
  return hold_motion(from, task.duration);
}

MotionPtr motion_of(const StudyTask&, const ArmModel&, const ArmState& from) { return hold_motion(from, 0); }

// Every way that a calibration may take, once: out to each pose and back.
MotionPtr motion_of(const CalibrateTask& task, const ArmModel& arm, const ArmState& from) {
  if (is_before_etalon(task)) return hold_motion(from, 0);  // The arm is not there.
  std::vector<double> times = {0};
  std::vector<ArmState> states = {from};
  for (const ArmState& pose : calibration_poses(task, arm.driven())) {
    for (const ArmState* next : {&pose, &from}) {
      times.push_back(times.back() + task.move_duration);
      states.push_back(*next);
    }
  }
  return keyframe_motion(std::move(times), states, Interpolation::linear);
}

MotionPtr motion_of(const ServoTask& task, const ArmModel& arm, const ArmState& from) {
  return servo_motion(servo_target_shapes(task, arm, from), arm.driven(), from);
}

// The shape that a move goes to. The search for one starts from where the arm is.
ArmState state_to_reach(const MoveTask& task, const ArmModel& arm, const ArmState& from) {
  const auto tip = tip_target(task);
  if (!tip) return arm_state(arm.driven(), task.to);
  InverseConfig config;
  config.start = from;
  return solve_inverse(arm, TipTarget{.position = *tip}, config).state;
}

// What is to be expected before it is simulated: the straight way to its target.
MotionPtr motion_of(const DynamicsTask& task, const ArmModel& arm, const ArmState& from) {
  if (!is_possible(from)) return hold_motion(from, task.duration);
  const DynamicsPlant plant(task, arm.driven(), from);
  return keyframe_motion({0, task.duration}, {from, plant.state(plant.target(), from)},
                         Interpolation::linear);
}

// Of the laws that take the task's duration. Without a default, so that the compiler asks for a new law's.
Profile profile_of(MoveLaw law, double duration) {
  switch (law) {
    case MoveLaw::linear:
      return Profile::linear(duration);
    case MoveLaw::minimum_jerk:
      return Profile::minimum_jerk(duration);
    case MoveLaw::trapezoid:
      break;
  }
  throw std::logic_error("a trapezoid finds its own duration");
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
  // With one law for all, cords and bends both go on straight lines.
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

// The formulas of one quantity, one for all sections or one each.
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

}  // namespace

// The straight way to each target, slowly.
MotionPtr servo_motion(const std::vector<std::optional<ServoTargetShape>>& shapes, const Arm& arm,
                       const ArmState& from) {
  // s a target, and more where sections are slower: the limiter obeys their rates. A smooth way is at most
  // three times as fast as its mean.
  constexpr double slow = 10, faster = 3;
  const auto lasts = [&](const ArmState& a, const ArmState& b) {
    double duration = slow;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const double bending = (b.bends[i] - a.bends[i]).norm(),
                   stretching = std::abs(b.stretches[i] - a.stretches[i]);
      duration = std::max({duration, faster * bending / arm.sections[i].max_bend_rate,
                           faster * stretching / arm.sections[i].max_stretch_rate});
    }
    return duration;
  };
  std::vector<double> times = {0};
  std::vector<ArmState> states = {from};
  for (const auto& shape : shapes) {
    if (!shape) continue;  // Nobody knows yet.
    times.push_back(times.back() + lasts(states.back(), shape->state));
    states.push_back(shape->state);
  }
  if (times.size() < 2) return hold_motion(from, 0);
  return keyframe_motion(std::move(times), states, Interpolation::smooth);
}

MotionPtr task_motion(const TaskConfig& task, const ArmModel& arm, const ArmState& from) {
  return std::visit([&](const auto& one) { return motion_of(one, arm, from); }, task);
}

}  // namespace flexura
