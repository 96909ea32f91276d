#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "flexura/experiment/keyframes.h"
#include "flexura/experiment/task_config.h"
#include "flexura/kinematics/expression.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/planar.h"
#include "flexura/kinematics/shape.h"

namespace flexura {
namespace {

// One value for all sections, or one each.
template <class T>
const T& of_section(const std::vector<T>& values, std::size_t section) {
  return values.size() == 1 ? values.front() : values[section];
}

// How far the section goes that goes farthest: rad of bend, and stretch as if 1 were 1 rad.
double distance(const ArmState& from, const ArmState& to) {
  double farthest = 0;
  for (std::size_t i = 0; i < from.bends.size(); ++i) {
    farthest = std::max(
        {farthest, (to.bends[i] - from.bends[i]).norm(), std::abs(to.stretches[i] - from.stretches[i])});
  }
  return farthest;
}

MotionPtr motion_of(const HoldTask& task, const Arm&, const ArmState& from) {
  return hold_motion(from, task.duration);
}

MotionPtr motion_of(const StudyTask&, const Arm&, const ArmState& from) { return hold_motion(from, 0); }

// Every way that a calibration may take, once: out to each pose and back.
MotionPtr motion_of(const CalibrateTask& task, const Arm& arm, const ArmState& from) {
  if (is_before_etalon(task)) return hold_motion(from, 0);  // The arm is not there.
  std::vector<double> times = {0};
  std::vector<ArmState> states = {from};
  for (const ArmState& pose : calibration_poses(task, arm)) {
    for (const ArmState* next : {&pose, &from}) {
      times.push_back(times.back() + task.move_duration);
      states.push_back(*next);
    }
  }
  return keyframe_motion(std::move(times), states, Interpolation::linear);
}

// The shape that a move goes to. The search for one starts from where the arm is.
ArmState state_to_reach(const MoveTask& task, const Arm& arm, const ArmState& from) {
  const auto tip = tip_target(task);
  if (!tip) return arm_state(arm, task.to);
  InverseOptions options;
  options.start = from;
  return solve_inverse(arm, TipTarget{.position = *tip}, options).state;
}

MotionPtr motion_of(const MoveTask& task, const Arm& arm, const ArmState& from) {
  const ArmState to = state_to_reach(task, arm, from);
  std::vector<Profile> profiles;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    switch (of_section(task.law, i)) {
      case MoveLaw::linear:
        profiles.push_back(Profile::linear(task.duration.value_or(1.0)));
        break;
      case MoveLaw::minimum_jerk:
        profiles.push_back(Profile::minimum_jerk(task.duration.value_or(1.0)));
        break;
      case MoveLaw::trapezoid: {
        const double farthest = distance(from, to);
        if (farthest == 0) return hold_motion(from, 0);
        profiles.push_back(Profile::trapezoid(farthest, *task.max_rate, *task.max_acceleration));
        break;
      }
    }
  }
  return point_to_point_motion(from, to, std::move(profiles));
}

MotionPtr motion_of(const SineTask& task, const Arm& arm, const ArmState& from) {
  std::vector<Eigen::Vector2d> amplitudes(arm.sections.size(), Eigen::Vector2d::Zero());
  if (task.amplitude.cord_angles) {
    // Swings of cord angles follow eq. 5 without its constant, the base's tangent angle.
    const auto archings = archings_from_cord_angles(*task.amplitude.cord_angles, 0.0);
    for (std::size_t i = 0; i < amplitudes.size(); ++i) amplitudes[i] = bend_from_arching(archings[i]);
  } else {
    amplitudes = arm_state(arm, task.amplitude).bends;
  }
  std::vector<double> phases;
  phases.reserve(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i) phases.push_back(of_section(task.phase, i));
  return sine_motion(from, std::move(amplitudes), std::move(phases), task.period, task.duration);
}

MotionPtr motion_of(const KeyframesTask& task, const Arm& arm, const ArmState&) {
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

MotionPtr motion_of(const ExpressionTask& task, const Arm& arm, const ArmState& from) {
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

MotionPtr task_motion(const TaskConfig& task, const Arm& arm, const ArmState& from) {
  return std::visit([&](const auto& one) { return motion_of(one, arm, from); }, task);
}

}  // namespace flexura
